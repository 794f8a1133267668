/// Faults of a cylinder with which its linear figures must be read with care.
#pragma once

#include <cstdint>

#include "hammer_loads/boom/cylinder.h"

namespace hammer_loads {

enum CylinderFlag : std::uint16_t {
  kChamberEmpty =
      1,  ///< a chamber's pressure would be negative: its oil cavitates, and the cylinder is softer than computed
  kForceReversed = 2,  ///< the force opposes the steady one: the pins cross their clearance
  kReliefReached = 4,  ///< a chamber carries its relief pressure: the valve opens, the joint yields
  kZeroMomentArm = 8,  ///< the cylinder does not hold the joint
};

/// Gauge pressures in both chambers of trapped oil [Pa].
struct ChamberPressures {
  double bore{}, rod{};
};

/// The steady load is carried by one chamber, the other is without pressure; what changes quickly is shared by both as
/// the oil's stiffness is. Negative: the chamber runs empty. Torques of the load on the joint [N m]: steady, as of
/// weight and slow motion, and total. Not at a zero moment arm.
ChamberPressures chamberPressures(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                                  double total_torque) noexcept;

/// Force of measured pressures in both chambers [N]; positive pushes the anchors apart.
inline double forceOf(const Cylinder& cylinder, const ChamberPressures& p) noexcept {
  return p.bore * cylinder.boreArea() - p.rod * cylinder.rodArea();
}

/// Sum of CylinderFlag. Empty: below absolute zero, 1 bar below gauge zero.
std::uint16_t cylinderFlags(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                            double total_torque) noexcept;

}  // namespace hammer_loads
