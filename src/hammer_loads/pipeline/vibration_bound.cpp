#include "hammer_loads/pipeline/vibration_bound.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kLongestDecay = 10.0;  // [s]
constexpr double kMostRate = 1.0;       // [rad/s]: neither operator nor rock moves a boom this fast
// Limit: kLongestDecay, kMostRate

}  // namespace

void VibrationBound::advance(const Vibration& vibration, double step, const TorqueStep& torque) noexcept {
  const BoomModes& modes = vibration.modes();
  const auto size = [&](const JointVector& t) { return modalForce(modes, t).norm(); };
  pushed_ += step * std::max({size(torque.from), size(torque.to), size(torque.mean)});
  pushed_ *= std::exp(-step / decayTime(vibration));
}

void VibrationBound::strike(const Vibration& vibration, const JointVector& impulse) noexcept {
  pushed_ += modalForce(vibration.modes(), impulse).norm();
}

bool VibrationBound::holds(const Vibration& vibration) const noexcept {
  if (!vibration.known()) return true;
  const JointVector rate = JointVector::Constant(vibration.modes().mass.rows(), kMostRate);
  const double others = std::sqrt(std::max(0.0, rate.dot(vibration.modes().mass * rate)));
  return std::sqrt(2.0 * vibration.energy()) <= 2.0 * (pushed_ + others);  // false also for values that are not finite
}

double VibrationBound::decayTime(const Vibration& vibration) noexcept {
  if (!vibration.known()) return kLongestDecay;
  const Mode lowest = vibration.mode(0);
  return std::min(kLongestDecay, 2.0 / (lowest.zeta * lowest.omega));
}

}  // namespace hammer_loads
