/// The boom's vibration under the hammer: each mode advanced exactly from sample to sample.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/mode.h"
#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

struct VibrationSettings {
  double damping_ratio{};  ///< damping ratio of every mode [-], in (0, 1)
  double refresh_angle{};  ///< new modes for each such move of a joint; theirs is off by half of it [rad], >= 0
};

/// Vibration of the joints about the pose that joint_states report. Between refreshes the modes stay; at a refresh
/// displacements and velocities of the joints carry over, so that what the boom's own motion does to the energy is kept
/// to first order. At a zero moment arm there is no answer (known() is false) and the boom comes to rest.
///
/// The load must be the part that comes from motion relative to the hull, the links' mass being in the hull's already.
class Vibration {
 public:
  static constexpr double kSwingTime = look_back::kFiveTurns;  ///< over which swings are followed [s]

  Vibration(const Chain& chain, std::vector<Cylinder> cylinders, const VibrationSettings& settings);

  /// Pose at the end of the step that advance() takes next, g_B: gravity in the root's axes [m/s2]. Finds new modes
  /// when a joint has moved far enough.
  void setPose(const JointVector& position, const Eigen::Vector3d& g_B) noexcept;
  /// At rest without load, as after a gap in the samples; the next setPose() finds new modes.
  void rest() noexcept;
  /// Resets to the start: at rest, frequencies and damping as given. This discards what wrong readings have identified.
  void startAnew() noexcept;
  /// Recent root mean square of each mode's displacement [m sqrt(kg)]; rest() leaves it as it is.
  JointVector usualSwing() const noexcept { return swing_.cwiseSqrt(); }
  /// Over a step [s] >= 0 of any size. Exact for torques linear between the ends plus a parabola that makes the mean.
  /// Where torques are so large that the state would not be finite, the boom comes to rest.
  void advance(double step, const TorqueStep& torque) noexcept;
  /// A blow's impulse as joint torque times time [N m s].
  void strike(const JointVector& impulse) noexcept;

  /// Frequencies and damping as readings show them, from now on (`boom_stiffness: identified`).
  void identify() { identifier_.emplace(settings_.damping_ratio, true, own_oil_); }
  bool identifies() const noexcept { return identifier_ && identifier_->learns(); }
  /// See ModeIdentifier; nothing without identify().
  void keepOil(bool keep) noexcept {
    if (identifier_) identifier_->keepOil(keep);
  }
  /// From now on the rock may bear on the hull: its force is followed with the motion that readings show. torque: on
  /// the joints per newton [N m/N]; call at each pose. Where its mean over some 0.5 s is less than least_force [N] the
  /// hull counts as free.
  void followContact(const JointVector& torque, double least_force) noexcept;
  void leaveContact() noexcept;  ///< no more: the hull counts as free
  /// By how much time the crank's angle, and the load with it, lead as far as is known. See ModeIdentifier.
  void expectCrankLead(const CrankLead& lead) noexcept {
    if (identifier_) identifier_->expectCrankLead(lead);
  }
  /// See ModeIdentifier; nothing where it is not used.
  void setSeals(std::size_t cylinder, const Seals& seals) noexcept {
    if (identifier_) identifier_->setSeals(cylinder, seals);
  }
  /// A sensor's readings at the end of the last step, see ModeIdentifier; nothing without identify() or
  /// followContact().
  void observe(const VibrationReading* readings, std::size_t count) noexcept;
  void observe(int channel, VibrationReading reading) noexcept {
    reading.channel = channel;
    observe(&reading, 1);
  }
  /// Stiffness of a cylinder's oil against the mean of the others': logarithm as identified, its standard deviation,
  /// and the standard deviation that the boom file leads one to expect.
  struct OilAgainstOthers {
    double stiffer{}, deviation{}, expected{};
  };
  /// Nothing while frequencies are not found, and without other cylinders.
  std::optional<OilAgainstOthers> oilAgainstOthers(std::size_t cylinder) const noexcept;
  /// Stiffness of a cylinder's oil over that of the boom file: logarithm as identified, and its standard deviation,
  /// which includes the effect of damping beside the oil.
  struct OilFound {
    double stiffer{}, deviation{};
  };
  /// Oil of a cylinder; none while frequencies are not identified.
  std::optional<OilFound> oilFound(std::size_t cylinder) const noexcept;
  /// Filter that follows the readings, if one does.
  const std::optional<ModeIdentifier>& identifier() const noexcept { return identifier_; }
  /// Displacement and velocity are those of the readings: all frequencies are known, or the rock bears on the hull.
  /// Else they are those of the hammer's load alone.
  bool followsReadings() const noexcept { return follows_readings_; }
  /// Force of the rock [N]. For a hull that counts as free: 0, or the mean force missing in the readings' motion.
  double contact() const noexcept { return contact_; }

  bool known() const noexcept { return modes_.count > 0; }
  /// No motion and no load.
  bool rests() const noexcept { return contact_ == 0.0 && x_.isZero(0.0) && v_.isZero(0.0) && force_.isZero(0.0); }
  ModeState motion(int mode) const noexcept { return {x_[mode], v_[mode]}; }  ///< motion of a mode
  double loadOn(int mode) const noexcept { return force_[mode]; }             ///< modal, at the end of the last step
  JointVector displacement() const noexcept;                                  ///< [rad], zero for held joints
  JointVector velocity() const noexcept;                                      ///< [rad/s]
  /// Displacement a short step [s] on, by the velocity [rad]; zero where it is no small vibration any more.
  JointVector displacementAfter(double step) const noexcept;
  JointVector acceleration() const noexcept;  ///< [rad/s2]
  /// -M q'': what vibration adds to the static torque of the load, so that hammer + vibration = what the cylinders hold
  /// (K q + C q') for the joints that they hold, and as above for the held ones [N m].
  JointVector torque() const noexcept;
  /// Torque that the oil carries, K q + C q', and its rate; by the readings where they are followed [N m, N m/s]. With
  /// the weight's share of K: the torque beside that of the weight where the vibration has taken it.
  struct OilTorque {
    JointVector now, rate;
  };
  OilTorque oilTorque() const noexcept;
  /// Oil torque that pressures show with a stamp this long [s] after the present, or before it if negative [N m].
  JointVector oilTorqueRead(double ahead) const noexcept;
  /// Kinetic energy and that of the oil's compression [J]; at a steady pose it only falls without load.
  double energy() const noexcept;
  const BoomModes& modes() const noexcept { return modes_; }
  Mode mode(int index) const noexcept {
    return {modes_.omega[index], identifier_ ? identifier_->damping(index) : settings_.damping_ratio};
  }

 private:
  JointVector modalAcceleration() const noexcept;
  void restIfNotFinite() noexcept;
  void useIdentified() noexcept;
  double oilDoubt(int cylinder) const noexcept;        ///< standard deviation of its log stiffness
  OilFound oilFound(const LogOil& by) const noexcept;  ///< weighted sum over the cylinders
  LogOil oilToTake() const noexcept;
  void useMotion() noexcept;
  void takeMotion() noexcept;
  void followSwing(double step) noexcept;
  double contactAtLoad(int mode) const noexcept { return contact_ * contact_by_newton_[mode]; }

  ChainDynamics dynamics_;
  std::vector<Cylinder> cylinders_;
  VibrationSettings settings_;
  LogOil own_oil_ = LogOil::Zero();  ///< deviation of each cylinder's oil against the common one
  std::optional<ModeIdentifier> identifier_;
  BoomModes modes_;
  JointVector position_;  ///< position for which the modes were found
  JointVector last_;      ///< position of the last setPose()
  bool posed_{};
  LogOil log_oil_ = LogOil::Zero();  ///< logarithms of the stiffness of the modes' oil over that given
  bool follows_readings_{};
  std::array<KeptStep, kMaxJoints> step_;                ///< last step of each mode
  JointVector x_, v_;                                    ///< modal displacements and velocities
  JointVector swing_;                                    ///< mean squares of the displacements
  JointVector contact_by_newton_;                        ///< modal force of the rock
  double contact_{}, mean_contact_{}, least_contact_{};  ///< [N]
  JointVector torque_, force_;  ///< torque of the load at the end of the last step; its modal force
};

}  // namespace hammer_loads
