#include "hammer_loads/hammer/blow.h"

#include "hammer_loads/linkage/motion.h"

namespace hammer_loads {

RockerBlow blowAtCrankSpeed(const Mechanism& mechanism, double crank_speed) noexcept {
  const HammerParameters& p = mechanism.parameters();
  RockerBlow blow;
  blow.rocker_speed_before = motion(mechanism.linkage(), {0.0, Side::kBeforeBlow}).u * crank_speed;
  blow.rocker_speed_after = motion(mechanism.linkage(), {0.0, Side::kAfterBlow}).u * crank_speed;
  blow.restitution = -blow.rocker_speed_after / blow.rocker_speed_before;

  const double inertia = p.rocker_inertia_about_pivot;
  blow.energy = 0.5 * inertia *
                (blow.rocker_speed_before * blow.rocker_speed_before - blow.rocker_speed_after * blow.rocker_speed_after);
  // At psi = 0: K = (-lK, 0), S = (-ls, 0); angular momentum about D, then momentum.
  const double jump = blow.rocker_speed_after - blow.rocker_speed_before;
  blow.tool_impulse_z = inertia * jump / p.striking_distance;
  blow.support_impulse_z = blow.tool_impulse_z - mechanism.rockerFirstMoment() * jump;
  return blow;
}

}  // namespace hammer_loads
