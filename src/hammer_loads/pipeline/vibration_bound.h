/// Whether the boom vibrates more than anything could have made it.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {

/// With E the energy of all modes of unit mass, sqrt(2 E) grows by no more than the size of the modal force times time,
/// and by the size of an impulse, whatever the frequencies; the lowest mode's damping takes from it. Sensors add what
/// operator and rock do: no more than all joints turning at kMostRate. What is beyond twice that sum is no vibration
/// but an observer that runs away.
class VibrationBound {
 public:
  void rest() noexcept { pushed_ = 0.0; }
  void advance(const Vibration& vibration, double step, const TorqueStep& torque) noexcept {
    const BoomModes& modes = vibration.modes();
    const auto size = [&](const JointVector& t) { return modalForce(modes, t).norm(); };
    pushed_ += step * std::max({size(torque.from), size(torque.to), size(torque.mean)});
    pushed_ *= std::exp(-step / decayTime(vibration));
  }
  void strike(const Vibration& vibration, const JointVector& impulse) noexcept {
    pushed_ += modalForce(vibration.modes(), impulse).norm();
  }
  bool holds(const Vibration& vibration) const noexcept {
    if (!vibration.known()) return true;
    const JointVector rate = JointVector::Constant(vibration.modes().mass.rows(), kMostRate);
    const double others = std::sqrt(std::max(0.0, rate.dot(vibration.modes().mass * rate)));
    return std::sqrt(2.0 * vibration.energy()) <= 2.0 * (pushed_ + others);  // false also for what is not finite
  }
  /// After which motion that was wrong has gone [s]: twice what the lowest mode's damping needs for a factor e.
  static double decayTime(const Vibration& vibration) noexcept {
    constexpr double kLongest = 10.0;  // [s]
    // Guard: VibratingBoom.AMotionThatNothingDampsIsOverAfterTenSeconds of kLongest
    if (!vibration.known()) return kLongest;
    const Mode lowest = vibration.mode(0);
    return std::min(kLongest, 2.0 / (lowest.zeta * lowest.omega));
  }

 private:
  static constexpr double kMostRate = 1.0;  // [rad/s]: no operator swings a boom as fast, no rock throws it so
  // Guard: VibratingBoom.NoOperatorSwingsItFasterThanARadianASecond of kMostRate
  double pushed_{};  ///< [m sqrt(kg)/s]
};

}  // namespace hammer_loads
