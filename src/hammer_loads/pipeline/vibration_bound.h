/// Upper bound on the vibration of the boom that can be caused by its loads.
#pragma once

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {

/// E is the energy of all modes of unit mass. At any frequency, sqrt(2 E) grows by at most the modal force times time
/// and by an impulse. The lowest mode's damping reduces it. Sensors add the effects of operator and rock, at most those
/// of all joints turning at 1 rad/s. A value beyond twice that sum is no vibration but a diverging observer.
class VibrationBound {
 public:
  void reset() noexcept { pushed_ = 0.0; }
  void advance(const Vibration& vibration, double step, const TorqueStep& torque) noexcept;
  void strike(const Vibration& vibration, const JointVector& impulse) noexcept;
  bool holds(const Vibration& vibration) const noexcept;
  /// Returns the time after which a wrong motion has decayed [s]: twice the lowest mode's time constant of damping.
  static double decayTime(const Vibration& vibration) noexcept;

 private:
  double pushed_{};  ///< [m sqrt(kg)/s]
};

}  // namespace hammer_loads
