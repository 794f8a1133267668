/// Pose in which the operator holds the boom, without the vibration that joint sensors may see.
#pragma once

#include "hammer_loads/boom/chain_dynamics.h"

namespace hammer_loads {

/// Joint angles by three filters of the first order in a row, 0.5 s each (Brown's triple exponential smoothing): a
/// joint that is driven at a constant acceleration is followed without lag; of a vibration of 3.4 Hz 28 % is left, of
/// one of 9 Hz 10 %. A vibration sampled at 50 Hz must not be taken for the boom's slow motion: as pose of the modes
/// and as velocity it would change joint torques by several per cent.
///
/// Error: 0.125 s^3 times the rate of the operator's acceleration; so while he drives a joint faster than 0.05 rad/s,
/// 2 s after that and 1 s after the start the joints count as they are measured. No allocation.
class HeldPose {
 public:
  /// Takes the measured joints less the known vibration, a step [s] after the previous call.
  void follow(const JointMotion& measured, double step) noexcept;
  /// Notes that a blow was struck in the last step.
  void struck() noexcept;
  bool isDriven() const noexcept { return unrest_ > 0.0; }
  /// Motion at the last call; as measured while driven. The acceleration is the operator's slow one, except while
  /// driven and for 2.5 s after that, after a gap and after the start, when it is the measured one.
  const JointMotion& motion() const noexcept { return motion_; }

  const JointVector& slowAngle() const noexcept { return slow_; }  ///< [rad], 1 s late
  JointVector slowRate() const noexcept;                           ///< [rad/s], 1 s late
  /// Joint rates by the operator at the last blow [rad/s]. A driven joint has its change of angle from blow to blow,
  /// over which the vibration repeats, extrapolated by half a revolution; others have slowRate().
  JointVector rateAtBlow() const noexcept { return isDriven() && of_turn_.size() > 0 ? of_turn_ : slowRate(); }

 private:
  void goOn(double step) noexcept;
  JointVector slowAcceleration() const noexcept;  ///< [rad/s2]; of a swing of 14 s 27 % are wrong

  JointVector angle_;                               ///< angle as measured
  JointVector at_blow_, of_turn_, of_turn_before_;  ///< angles; rates of the last turn drawn on, and of it [rad/s]
  double since_blow_{};                             ///< [s]
  JointVector first_, slow_, slowest_, last_;       ///< angles through one to four filters [rad]
  double unrest_{};    ///< time for which the operator's last fast motion, or a gap, still counts [s]
  double settling_{};  ///< time for which the acceleration is not known [s]
  JointMotion motion_;
};

}  // namespace hammer_loads
