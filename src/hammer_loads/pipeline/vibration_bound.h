/// Bound on the vibration of the boom: more than it nothing could have caused.
#pragma once

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {

/// With E the energy of all modes of unit mass, sqrt(2 E) grows by no more than the size of the modal force times time,
/// and by the size of an impulse, whatever the frequencies; the lowest mode's damping takes from it. Sensors add the
/// effects of operator and rock: no more than all joints turning at 1 rad/s. A value beyond twice that sum is no
/// vibration but a diverging observer.
class VibrationBound {
 public:
  void reset() noexcept { pushed_ = 0.0; }
  void advance(const Vibration& vibration, double step, const TorqueStep& torque) noexcept;
  void strike(const Vibration& vibration, const JointVector& impulse) noexcept;
  bool holds(const Vibration& vibration) const noexcept;
  /// After which motion that was wrong has gone [s]: twice what the lowest mode's damping needs for a factor e.
  static double decayTime(const Vibration& vibration) noexcept;

 private:
  double pushed_{};  ///< [m sqrt(kg)/s]
};

}  // namespace hammer_loads
