/// Frequency and damping of the boom's modes, followed from what sensors see of its vibration.
#pragma once

#include <array>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/mode.h"

namespace hammer_loads {

/// What one channel of a sensor reads: offset + displacement . q + velocity . q' + acceleration . q'' of the joints'
/// vibration q. Whatever else it sees (weight, the boom's slow motion) must be taken off value first, as far as known;
/// the offset takes up what is left of it.
struct VibrationReading {
  JointVector displacement, velocity, acceleration;
  double value{};
  double noise{};             ///< standard deviation of one reading, unit of value
  double offset_deviation{};  ///< of its offset at the start, unit of value
  double offset_walk{};       ///< how far the offset wanders in a second, unit of value
};

/// Turning rate [rad/s] about a unit vector n in the tip's axes; J of tipJacobian().
VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate);
/// What an accelerometer at p reads along n [m/s2], acceleration less gravity g (all in the tip's axes).
VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration);
/// A joint's angle [rad]: above 100 Hz it shows the vibration.
VibrationReading jointAngleReading(int joints, int joint, double angle);
/// Torque of the load on a joint by its cylinder's measured force [N m] (-force times arm), less hammer, weight and
/// motion: -M q''.
VibrationReading jointTorqueReading(const BoomModes& modes, int joint, double torque);

/// Extended Kalman filter: per mode displacement, velocity, logarithm of frequency over the given one and of damping
/// over the given one; per channel an offset. Steps are the same as those of Vibration, between them come readings in
/// any order. No allocation. Shapes are those of the given stiffness: what is found is exact where all cylinders' oil
/// is wrong by one factor, and each mode's own best where not.
///
/// First guesses: frequencies wrong by 15 % together (bulk modulus by 30 %) and 5 % each beside, damping by a
/// factor 1.6. Forces on the boom are taken as wrong by 5 % of their root mean square over some 10 ms, independently.
class ModeIdentifier {
 public:
  static constexpr int kMaxChannels = 12;

  explicit ModeIdentifier(double damping_ratio);

  /// Modes by the given stiffness at the present pose; call when Vibration finds new ones. Displacements and velocities
  /// of the joints carry over.
  void setModes(const BoomModes& given) noexcept;
  /// Over a step [s], as Vibration::advance().
  void advance(double step, const TorqueStep& torque) noexcept;
  /// As Vibration::strike().
  void strike(const JointVector& impulse) noexcept;
  /// Vibration unknown, as after a gap; what is known of frequencies and damping stays.
  void forgetMotion() noexcept;
  /// A reading at the present time; channel in [0, kMaxChannels) keeps its offset. A reading far off counts less.
  void observe(int channel, const VibrationReading& reading) noexcept;

  int modes() const noexcept { return count_; }
  int channels() const noexcept { return channels_; }  ///< that have had a reading
  /// Over the given frequency [-].
  double frequencyRatio(int mode) const noexcept { return ratio_[static_cast<std::size_t>(mode)]; }
  /// Ratio of damping [-].
  double damping(int mode) const noexcept { return damping_[static_cast<std::size_t>(mode)]; }
  double frequencyDeviation(int mode) const noexcept;  ///< standard deviation of its logarithm [-]
  double dampingDeviation(int mode) const noexcept;    ///< standard deviation of its logarithm [-]
  /// Every mode's frequency is known to 3 %: better than most stiffnesses that are given.
  bool identified() const noexcept;
  JointVector displacement() const noexcept;  ///< of the joints as estimated [rad]
  JointVector velocity() const noexcept;      ///< [rad/s]

 private:
  static constexpr int kMaxStates = 4 * kMaxJoints + kMaxChannels;
  using State = Eigen::Matrix<double, kMaxStates, 1>;
  using Covariance = Eigen::Matrix<double, kMaxStates, kMaxStates>;
  enum Part { kX, kV, kFrequency, kDamping, kParts };

  static constexpr int at(int mode, Part part) noexcept { return kMaxChannels + kParts * mode + part; }
  /// Offsets are taken from the modes downwards, in the order of use: what is in use is one block.
  int offsetAt(int channel) const noexcept { return slot_[static_cast<std::size_t>(channel)]; }
  int begin() const noexcept { return kMaxChannels - channels_; }
  int states() const noexcept { return channels_ + kParts * count_; }

  void advanceMode(int mode, double step, const ModeForce& force) noexcept;
  void transform(const JointMatrix& T) noexcept;
  void useChannel(int channel, const VibrationReading& reading) noexcept;
  State rowOf(int channel, const VibrationReading& reading, double& predicted) const noexcept;
  bool finite() const noexcept;
  void keepWithinBounds() noexcept;

  double damping_ratio_;
  BoomModes modes_;
  int count_{};
  bool moving_known_{};  ///< displacement and velocity belong to modes_
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Zero();
  JointVector force_;                             ///< modal, at the present time
  std::array<double, kMaxJoints> force_power_{};  ///< mean square of each modal force, over some seconds
  Mode modeAt(int mode) const noexcept { return {modes_.given_omega[mode] * frequencyRatio(mode), damping(mode)}; }

  std::array<double, kMaxJoints> ratio_{}, damping_{};  ///< of state_
  int channels_{};                                      ///< in use
  std::array<int, kMaxChannels> slot_{};                ///< state of each channel's offset; -1: not in use
  std::array<double, kMaxChannels> age_{};              ///< since the channel's last reading [s]
};

}  // namespace hammer_loads
