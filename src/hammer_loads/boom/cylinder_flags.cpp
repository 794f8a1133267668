#include "hammer_loads/boom/cylinder_flags.h"

#include <algorithm>

namespace hammer_loads {

ChamberPressures chamberPressures(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                                  double total_torque) noexcept {
  const double steady = -steady_torque / position.arm, change = -(total_torque - steady_torque) / position.arm;
  const OilVolumes volume = cylinder.volumes(position.length);
  const double bore = cylinder.boreArea(), rod = cylinder.rodArea();
  // Pressure per force of both, by the same stroke: dp = B A dL/V.
  const double bore_share = bore / volume.bore, rod_share = rod / volume.rod;
  const double stroke = change / (bore * bore_share + rod * rod_share);
  return {std::max(steady, 0.0) / bore + bore_share * stroke, std::max(-steady, 0.0) / rod - rod_share * stroke};
}

std::uint16_t cylinderFlags(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                            double total_torque) noexcept {
  if (position.zero_moment_arm) return kZeroMomentArm;
  constexpr double kVacuum = -1.0e5;  // [Pa]
  const ChamberPressures p = chamberPressures(cylinder, position, steady_torque, total_torque);
  const double relief = cylinder.parameters().relief_pressure;
  const bool empty = p.bore < kVacuum || p.rod < kVacuum;
  const bool reversed = steady_torque * total_torque < 0.0;
  const bool yields = p.bore >= relief || p.rod >= relief;
  return static_cast<std::uint16_t>((empty ? kChamberEmpty : 0) | (reversed ? kForceReversed : 0) |
                                    (yields ? kReliefReached : 0));
}

}  // namespace hammer_loads
