/// The boom under the hammer, sample by sample: its pose, the loads of its joints and cylinders, and its vibration.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/boom/hold_down.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/cylinder_pressures.h"
#include "hammer_loads/pipeline/held_pose.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/joint_buffer.h"
#include "hammer_loads/pipeline/measured_torques.h"
#include "hammer_loads/pipeline/mode_observer.h"
#include "hammer_loads/pipeline/sensor_trust.h"
#include "hammer_loads/pipeline/torque_worth.h"
#include "hammer_loads/pipeline/vibration_bound.h"
#include "hammer_loads/pipeline/wrench_path.h"

namespace hammer_loads {

enum class Known {
  kGiven,     ///< vibration computed with the boom file's oil and the hammer's load
  kFollowed,  ///< vibration estimated from readings
  kMeasured,  ///< pressures in all cylinders give torques and the rock's force as well
};

/// One accepted crank sample.
struct BoomSample {
  StampNs stamp{};
  HullWrench motion_wrench;  ///< wrench at the end of the step's last piece, from the links' motion relative to the
                             ///< hull: no weight, no hull motion
  WrenchSpread spread{};     ///< errors of motion_wrench; none: not known
  /// Errors of constants from constantErrors() and hammerErrors(), equal in all samples. Zero means exact.
  Eigen::Matrix3d constants = Eigen::Matrix3d::Zero(), of_hammer = Eigen::Matrix3d::Zero();
  std::optional<StampedImuReading> imu{};  ///< a new reading, in the hull's axes
  bool imu_lost{};                         ///< earlier readings cannot be used
  HullWrench displaced_links{};            ///< DisplacedLinks at the sample; used for a compliant boom
  double stamp_noise{};                    ///< standard deviation of the stamp, from sample to sample [s]
  double unseen_peak{};                    ///< peak Fz if the hammer may have worked unobserved before, otherwise 0 [N]
};

/// Reasons for which the boom is modelled as rigid or compliant.
struct BoomChoice {
  bool compliant{};           ///< published loads include vibration
  bool judged{};              ///< true once a revolution has ended; the figures below are those of the last one
  double pulse_length{};      ///< pi/mu of its pulse [s]
  double lowest_frequency{};  ///< lowest natural frequency of the boom at its end [Hz], 0 without modes
  double rigid_error{};       ///< error of a rigid boom's joint torques for such a pulse, over the largest [-]; see
                              ///< rigidError()
  double rigid_tolerance{};   ///< [-]
};

/// Results of one crank sample. With a fault only stamp and fault are valid.
struct BoomState {
  StampNs stamp{};
  std::optional<JointFault> fault;
  BoomLoads loads;
  SteelLoads steel;           ///< sections and joints as Boom orders them
  BoomDeviations deviations;  ///< standard deviations of loads and steel; NaN where the crank has no covariance
  BoomDeviations common;      ///< part of `deviations` due to constants of crank sensor, hammer and boom
  std::array<std::uint16_t, kMaxJoints> cylinder_flags{};  ///< sum of CylinderFlag, index as in Boom::cylinders()
  bool zero_moment_arm{};      ///< a cylinder does not hold its joint: no modes, modelled as rigid
  JointVector frequency;       ///< natural frequencies, per mode [Hz]; none when vibration is not followed
  JointVector frequency_std;   ///< standard deviations of the frequencies [Hz]
  JointVector damping;         ///< damping ratio of each mode [-]
  bool identified{};           ///< frequencies and damping follow the sensors
  JointVector contact_torque;  ///< BY the rock ON the hull beyond the blows, as torque on the joints [N m]
  Wrench contact;              ///< contact load BY the rock ON the tip, axes of the tip; zero where it is not measured
  bool measured{};             ///< the cylinders' forces are those of measured pressures
  bool contact_unknown{};      ///< the IMU shows contact with the rock, but no pressures measure its force
  /// True if, with pressures or an IMU, torques are too uncertain to publish any loads, or not proven (TorqueWorth).
  bool useless{};
  bool hold_down_force_lost{};  ///< the rock does not press on the hull, by measured pressures
  ReducedHull reduced;          ///< along hull z; infinite without modes
  Boom::TipVibration tip;       ///< zero for a rigid boom
  /// Velocity due to vibration, mean of before and after the step's last blow; zero for a rigid boom, empty: no blow.
  std::optional<TipVelocity> at_blow;
  BoomChoice choice;
  std::optional<HoldDown> hold_down;  ///< against the mean hold-down force of the last revolution that had one
};

/// Owns the boom and its joints' states. The vibration is computed from the first sample on if it may be needed later,
/// so that loads do not jump. With `boom: auto` a boom with cylinders is compliant until the first revolution has
/// ended. No allocation after construction.
class BoomFollower {
 public:
  /// settings.boom must not be kNone. striking_distance: from D to the tool's axis, at -x of the hull [m].
  BoomFollower(Boom boom, const PipelineSettings& settings, double striking_distance);

  bool jointStates(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                   const std::vector<double>& velocities) noexcept {
    return joints_.update(stamp, names, positions, velocities);
  }
  /// Takes the gauge pressure [Pa] of a cylinder, index as in Boom::cylinders(). Returns true if it was accepted.
  bool pressure(StampNs stamp, std::size_t cylinder, Chamber chamber, double pressure) noexcept {
    const double offset = chamber == Chamber::kBore ? boom_.cylinders()[cylinder].parameters().pressure_offset : 0.0;
    return pressures_.update(stamp, cylinder, chamber, pressure - offset);
  }
  /// Computes the loads at a sample. step: since the previous sample; without pieces (after a restart or a gap) the
  /// boom is at rest. The result is valid until the next call.
  const BoomState& sample(const BoomSample& sample, const WrenchHistory& step) noexcept;
  /// Advances over a crank sample without loads: the boom continues to vibrate, freely if the step has no pieces.
  void advanceWithoutLoads(StampNs stamp, const WrenchHistory& step) noexcept;
  /// Returns the covariance of the tip's acceleration due to vibration, along x and z [m/s2] and about y [rad/s2]. It
  /// follows from the sensors or, without identification, from the boom file; zero for a rigid boom.
  Eigen::Matrix3d tipCovariance() const noexcept;
  /// Returns the tip's velocity at the last blow due to the operator's motion, without vibration.
  TipVelocity drivenTip() const noexcept;
  /// Returns the force along z that would explain the IMU's residuals, root mean square over a second [N].
  double unexplainedForce() const noexcept { return std::sqrt(unexplained_); }
  /// Returns the largest ratio of standard deviation to joint torque, root mean squares over a revolution [-].
  double torqueUncertainty() const noexcept { return worth_.ratio(); }
  bool isUnproven() const noexcept { return worth_.isUnproven(); }  ///< see TorqueWorth
  std::uint64_t useless() const noexcept { return useless_; }       ///< samples whose loads were useless
  /// Takes the crank's standard deviations. Call once per revolution.
  void expectCrankLead(const CrankLead& lead) noexcept { boom_.vibration().expectCrankLead(lead); }
  /// Ends a revolution with its pulse and its mean hold-down force [N]. Call once per revolution; it takes some 0.1 ms.
  void turnEnded(const std::optional<HalfSinePulse>& pulse, double mean_hold_down_force) noexcept;

  /// Returns the index in the chain, for wrenchAtLink(); empty for other TF frames.
  std::optional<int> linkIndex(const std::string& link) const noexcept { return boom_.chain().linkIndex(link); }
  /// Transforms a load on the hull about D to the origin and axes of a link, at the last sample's pose from the joints'
  /// sensors.
  Wrench wrenchAtLink(int link, const HullWrench& load) const noexcept;

  const BoomState& state() const noexcept { return state_; }
  bool known() const noexcept { return known_; }  ///< the last sample had no fault
  /// Returns the source of the last sample's loads.
  Known source() const noexcept {
    if (tip_) return Known::kMeasured;
    return boom_.vibration().followsReadings() ? Known::kFollowed : Known::kGiven;
  }
  /// Returns true if measured pressures show the rock's force on the hull.
  bool contactKnown() const noexcept { return known_ && source() == Known::kMeasured && !state_.useless; }
  const Boom& boom() const noexcept { return boom_; }
  /// Returns the angle of a cylinder's joint at the last sample [rad].
  double jointAngle(std::size_t cylinder) const noexcept {
    return motion_.position[boom_.cylinders()[cylinder].joint()];
  }
  const JointBuffer& joints() const noexcept { return joints_; }
  const CylinderPressures& pressures() const noexcept { return pressures_; }
  bool imuStampsJitter() const noexcept {
    const std::optional<ModeIdentifier>& identifier = boom_.vibration().identifier();
    return identifier && identifier->imuStampsJitter();
  }
  const PressureTrust& pressureTrust() const noexcept { return trust_; }
  std::uint64_t faults() const noexcept { return faults_; }  ///< number of crank samples with unknown joints
  /// Returns the reasons why the joints were not known at the last sample, one text per joint; empty where they were.
  std::vector<std::string> complaints() const;
  /// Returns how often the vibration was implausibly large and was reset. Its loads are withheld until the effect of
  /// the fault has decayed.
  std::uint64_t divergences() const noexcept { return divergences_; }
  /// Returns the name of the contact to which state().hold_down.least belongs, such as "front edge" or a cylinder's
  /// name; empty when unknown.
  const std::string& firstToGive() const noexcept;
  /// Returns true while pressures of the cylinders are in use.
  bool pressuresCount() const noexcept { return pressures_.accepted() > 0 && !trust_.isLost(); }

 private:
  static Wrench onTip(const HullWrench& w) noexcept;
  JointVector hammerTorque(const HullWrench& w) const noexcept;
  void addHammerTorque(const HullWrench& w, JointVector& torque) const noexcept;
  bool usesCompliant() const noexcept;
  void vibrate(const WrenchHistory& step, const HullWrench& displaced_links, const WrenchSpread& spread) noexcept;
  void strike(const HullWrench& impulse) noexcept;
  bool diverges(double step) noexcept;
  void beginUnseen(double peak) noexcept;
  void pose(double since) noexcept;
  void findLoads(const BoomSample& sample, double step) noexcept;
  void forgetWrongReadings(bool imu_lost) noexcept;
  void observe(const BoomSample& sample, double step) noexcept;
  Eigen::Matrix3d tipCovarianceAsGiven() const noexcept;
  void learnUnexplained(const ImuReading& reading, double step) noexcept;
  WrenchSpread spreadWithRock(const WrenchSpread& of_crank) const noexcept;
  void updateMeasured(const BoomSample& sample, double step) noexcept;
  void useMeasured() noexcept;
  void followContact(StampNs stamp) noexcept;
  void findContact(double step) noexcept;
  void addBending() noexcept;
  void addConstantsOfBoom(bool common_known) noexcept;
  void findDeviations(const WrenchSpread& spread, bool rigid) noexcept;
  void addConstants(const BoomSample& sample) noexcept;
  LoadErrors measuredErrors(const Wrench& lasting, bool rigid) const noexcept;
  LoadErrors followedErrors(const WrenchSpread& spread, bool rigid) const noexcept;
  void fillVibration() noexcept;
  void fillModes() noexcept;

  Boom boom_;
  VibrationSpread spread_;
  JointBuffer joints_;
  CylinderPressures pressures_;
  MeasuredTorques measured_;
  PressureTrust trust_;
  int lost_sensors_{};  ///< number of sensors that cannot be used
  TorqueWorth worth_;
  std::uint64_t useless_{};
  HeldPose held_;
  ModeObserver observer_;
  BoomModel model_;
  double striking_distance_;
  Eigen::Vector3d g_B_;  ///< gravity in the root's axes [m/s2]
  bool follow_vibration_;
  BoomState state_;
  JointMotion motion_;
  TorqueStep torque_;
  HullWrench displaced_links_;     ///< at the last sample
  JointVector unmodelled_torque_;  ///< change of inertia torque due to vibration that modes at a fixed pose neglect
  std::optional<InPlaneTip> tip_;  ///< at the sample; empty if the rock's force is not measured
  double unexplained_{};           ///< mean square of the force along z that would explain the IMU's readings [N2]
  double least_contact_{};         ///< force along z below which there is no contact [N]
  std::optional<StampNs> last_blow_;
  StampNs last_stamp_{};  ///< stamp of the last sample without a fault
  bool known_{};
  std::uint64_t faults_{}, divergences_{};
  VibrationBound bound_;
  double withheld_for_{};            ///< remaining time without loads after a reset of the vibration [s]
  std::vector<std::string> givers_;  ///< names of edges, then of cylinders
  std::string no_giver_;
};

}  // namespace hammer_loads
