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
  double refresh_angle{};  ///< move of a joint after which the modes are computed again; their pose is off by at most
                           ///< half of it [rad], >= 0
};

/// Vibration of the joints about the pose that joint_states report. The modes are kept between refreshes. At a refresh
/// the displacements and velocities of the joints are transformed, so that the effect of the boom's slow motion on the
/// energy is right to first order. At a zero moment arm the vibration is not known (known() is false) and the boom
/// comes to rest.
///
/// The load must be the part by motion relative to the hull, since the hull's mass includes that of the moving links.
class Vibration {
 public:
  static constexpr double kSwingTime = look_back::kFiveTurns;  ///< averaging time of the vibration's amplitude [s]

  Vibration(const Chain& chain, std::vector<Cylinder> cylinders, const VibrationSettings& settings);

  /// Pose at the end of the step that advance() takes next, g_B: gravity in the root's axes [m/s2]. Finds new modes
  /// when a joint has moved far enough.
  void setPose(const JointVector& position, const Eigen::Vector3d& g_B) noexcept;
  /// Sets the boom at rest without load, as after a gap in the samples. The next setPose() computes new modes.
  void reset() noexcept;
  /// Resets to the start: at rest, frequencies and damping as given. This discards what wrong readings have identified.
  void startAnew() noexcept;
  /// Recent root mean square of each mode's displacement [m sqrt(kg)]; reset() leaves it as it is.
  JointVector usualSwing() const noexcept { return swing_.cwiseSqrt(); }
  /// Advances by a step [s] >= 0 of any size. Exact for torques that are linear between the ends plus a parabola with
  /// the given mean.
  /// Where torques are so large that the state would not be finite, the boom comes to rest.
  void advance(double step, const TorqueStep& torque) noexcept;
  /// A blow's impulse as joint torque times time [N m s].
  void strike(const JointVector& impulse) noexcept;

  /// Identifies frequencies and damping from now on (`boom_stiffness: identified`).
  void identify() { identifier_.emplace(settings_.damping_ratio, true, own_oil_); }
  bool identifies() const noexcept { return identifier_ && identifier_->learns(); }
  /// See ModeIdentifier; no effect without identify().
  void keepOil(bool keep) noexcept {
    if (identifier_) identifier_->keepOil(keep);
  }
  /// Estimates the force of the rock on the hull from now on, together with the motion. torque: joint torques per
  /// newton [N m/N]; call at each pose. The hull is free while the mean of the force over 0.5 s is less than
  /// least_force [N].
  void followContact(const JointVector& torque, double least_force) noexcept;
  void leaveContact() noexcept;  ///< ends the estimate of the rock's force; the hull is free
  /// Sets the expected lead of the crank's angle, and thereby of the load. See ModeIdentifier.
  void expectCrankLead(const CrankLead& lead) noexcept {
    if (identifier_) identifier_->expectCrankLead(lead);
  }
  /// See ModeIdentifier; empty where it is not used.
  void setSeals(std::size_t cylinder, const Seals& seals) noexcept {
    if (identifier_) identifier_->setSeals(cylinder, seals);
  }
  /// Updates by a sensor's readings at the end of the last step, see ModeIdentifier. No effect without identify() or
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
  /// Empty until the frequencies are identified, and for a single cylinder.
  std::optional<OilAgainstOthers> oilAgainstOthers(std::size_t cylinder) const noexcept;
  /// Stiffness of a cylinder's oil over that of the boom file: logarithm as identified, and its standard deviation,
  /// which includes the effect of damping beside the oil.
  struct IdentifiedOil {
    double stiffer{}, deviation{};
  };
  /// Oil of a cylinder; none while frequencies are not identified.
  std::optional<IdentifiedOil> identifiedOil(std::size_t cylinder) const noexcept;
  /// Filter that estimates the motion from readings; null without one.
  const std::optional<ModeIdentifier>& identifier() const noexcept { return identifier_; }
  /// True if displacement and velocity are estimated from readings, as all frequencies are known or the rock bears on
  /// the hull. Otherwise they are the response to the hammer's load alone.
  bool followsReadings() const noexcept { return follows_readings_; }
  /// Force of the rock [N]. For a free hull 0, or the mean force that the motion of the readings requires.
  double contact() const noexcept { return contact_; }

  bool known() const noexcept { return modes_.count > 0; }
  /// No motion and no load.
  bool rests() const noexcept { return contact_ == 0.0 && x_.isZero(0.0) && v_.isZero(0.0) && force_.isZero(0.0); }
  ModeState motion(int mode) const noexcept { return {x_[mode], v_[mode]}; }  ///< motion of a mode
  double loadOn(int mode) const noexcept { return force_[mode]; }             ///< modal, at the end of the last step
  JointVector displacement() const noexcept;                                  ///< [rad], zero for held joints
  JointVector velocity() const noexcept;                                      ///< [rad/s]
  /// Displacement after a short step [s], extrapolated by the velocity [rad]; zero where the vibration is no longer
  /// small.
  JointVector displacementAfter(double step) const noexcept;
  JointVector acceleration() const noexcept;  ///< [rad/s2]
  /// -M q'': torque of the vibration in addition to the static torque of the load [N m]. Hammer and vibration together
  /// are the torque of the cylinders, K q + C q', at the joints with a cylinder, and the reaction at held joints.
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
  double oilDeviation(int cylinder) const noexcept;              ///< standard deviation of its log stiffness
  IdentifiedOil identifiedOil(const LogOil& by) const noexcept;  ///< weighted sum over the cylinders
  LogOil oilToTake() const noexcept;
  void useMotion() noexcept;
  void storeMotion() noexcept;
  void followSwing(double step) noexcept;
  double contactAtLoad(int mode) const noexcept { return contact_ * contact_by_newton_[mode]; }

  MassMatrix mass_;
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
