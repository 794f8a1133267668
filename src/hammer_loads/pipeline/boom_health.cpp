#include "hammer_loads/pipeline/boom_health.h"

#include <cmath>

#include "hammer_loads/estimation/gates.h"

namespace hammer_loads {

int modeOfOddDamping(const Boom& boom) noexcept {
  const double given = boom.parameters().vibration.damping_ratio;
  int mode = -1;
  double farthest = gate::kUsual * kDampingDeviation;
  for (int k = 0; k < boom.vibration().modes().count; ++k) {
    const double off = std::abs(std::log(boom.vibration().mode(k).zeta / given));
    if (off > farthest) mode = k, farthest = off;
  }
  return mode;
}

std::optional<BoomHealth> boomHealth(const BoomFollower& follower) noexcept {
  const BoomState& state = follower.state();
  const Vibration& vibration = follower.boom().vibration();
  if (!follower.known() || !state.identified || state.zero_moment_arm || !vibration.identifier()->explains() ||
      vibration.identifier()->waitsForDelay())
    return std::nullopt;
  BoomHealth health;
  health.count = vibration.modes().count;
  health.oil_explains = modeOfOddDamping(follower.boom()) < 0;
  for (int i = 0; i < health.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto found = vibration.identifiedOil(at);
    if (!found) return std::nullopt;
    BoomHealth::OfCylinder& c = health.cylinder[at];
    c.joint_angle = follower.jointAngle(at);
    c.stiffness = std::exp(found->stiffer);
    // A stiffness is proportional to the square of a frequency, so that a relative error of the frequency counts twice.
    c.deviation = c.stiffness * std::hypot(found->deviation, 2.0 * ModeIdentifier::kLeftFrequency);
    BoomHealth::OfMode& m = health.mode[at];
    m.frequency = state.frequency[i], m.deviation = state.frequency_std[i];
    m.damping = state.damping[i];
    m.damping_std = m.damping * std::hypot(vibration.identifier()->dampingDeviation(i), ModeIdentifier::kLeftDamping);
  }
  return health;
}

}  // namespace hammer_loads
