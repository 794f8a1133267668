/// Pose in which the operator holds the boom, without the vibration that joint sensors may see.
#pragma once

#include "hammer_loads/boom/chain_dynamics.h"

namespace hammer_loads {

/// Joint angles after three first-order filters in series, 0.5 s each (Brown's triple exponential smoothing). A joint
/// driven at a constant acceleration is followed without lag. A vibration of 3.4 Hz is reduced to 28 %, one of 9 Hz to
/// 10 %. A vibration sampled at 50 Hz must not be mistaken for the boom's slow motion. In the pose of the modes and in
/// the velocity it would change joint torques by several per cent.
///
/// Error: 0.125 s^3 times the change rate of the operator's acceleration. Measured joints are therefore used while a
/// joint is driven faster than 0.05 rad/s, for 2 s after that and for 1 s after the start. No allocation.
class HeldPose {
 public:
  /// Takes the measured joints minus the known vibration, a step [s] after the previous call.
  void follow(const JointMotion& measured, double step) noexcept;
  /// Notes that a blow was struck in the last step.
  void struck() noexcept;
  bool isDriven() const noexcept { return unrest_ > 0.0; }
  /// Returns the motion at the last call; as measured while driven. The acceleration is the operator's slow one. It is
  /// the measured one while driven and for 2.5 s after that, after a gap and after the start.
  const JointMotion& motion() const noexcept { return motion_; }

  const JointVector& slowAngle() const noexcept { return slow_; }  ///< [rad], 1 s late
  JointVector slowRate() const noexcept;                           ///< [rad/s], 1 s late
  /// Returns joint rates due to the operator at the last blow [rad/s]. A driven joint has its change of angle from blow
  /// to blow, over which the vibration repeats, extrapolated by half a revolution; others have slowRate().
  JointVector rateAtBlow() const noexcept { return isDriven() && of_turn_.size() > 0 ? of_turn_ : slowRate(); }

 private:
  void goOn(double step) noexcept;
  JointVector slowAcceleration() const noexcept;  ///< [rad/s2]; error of 27 % for a swing with a period of 14 s

  JointVector angle_;                               ///< angle as measured
  JointVector at_blow_, of_turn_, of_turn_before_;  ///< angles; extrapolated and mean rate of the revolution [rad/s]
  double since_blow_{};                             ///< [s]
  JointVector first_, slow_, slowest_, last_;       ///< angles through one to four filters [rad]
  double unrest_{};                                 ///< remaining time for which measured joints are used [s]
  double settling_{};                               ///< remaining time for which the acceleration is not known [s]
  JointMotion motion_;
};

}  // namespace hammer_loads
