/// Stiffness of each cylinder's oil and damping of the boom's modes, identified from sensor readings of the vibration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/cylinder_oil.h"
#include "hammer_loads/boom/mode.h"
#include "hammer_loads/boom/mode_history.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/timing_noise.h"

namespace hammer_loads {

/// Time by which the measured crank angle leads the crank [s], and its standard deviation.
struct CrankLead {
  double mean{}, deviation{};
};

/// Extended Kalman filter (doc/boom.md, 7): per mode displacement, velocity and logarithm of damping over the given
/// one; per cylinder the logarithm of its oil's stiffness over that of the modes given and, with pressures, the
/// friction of its seals; per channel an offset. The steps are those of Vibration, with readings in any order between
/// them. No allocation. Frequencies are expanded to second order in the identified stiffnesses, and the mode shapes are
/// those given. The caller therefore provides new modes before the stiffnesses have changed much.
///
/// Prior: a common error of 30 % of all stiffnesses, an own error of each, and a factor of 1.6 of the damping. The
/// forces on the boom have independent errors of 5 % of their root mean square, correlated over 10 ms.
///
/// A hull that bounces on rock is moved by forces that the model lacks. While the residuals of the accelerations are
/// twice their expected size, the given stiffnesses and damping are used. If no stiffness has explained the
/// accelerations so far, the identification restarts once with modes that are recomputed at each step (seeks()),
/// because a cylinder that is much softer changes the mode shapes.
///
/// Each clock has one delay, a random walk. The filter runs in the IMU's time: the hammer's forces and blows act later
/// by the IMU's delay, which makes it observable; the pressures have a delay relative to the IMU. The part of a common
/// delay that the crank's model expects (expectCrankLead()) is attributed to the crank.
///
/// The rock's force is a further state where followContact() was called: a random walk that fits a landing.
class ModeIdentifier {
 public:
  static constexpr int kMaxChannels = 12;
  static constexpr double kMostOil = 2.0;  ///< largest identified log stiffness: a frequency of e times the given one
  // Prior: kMostOil
  /// Remaining errors of log frequency and log damping of an identified mode: the links move in the hull, and bend.
  static constexpr double kLeftFrequency = 0.005, kLeftDamping = 0.1;
  /// Remaining error of an identified friction of seals, over the deviation before: three cylinders share a motion.
  static constexpr double kLeftRubbing = 0.25;
  // Prior: kLeftFrequency, kLeftDamping, kLeftRubbing

  /// learns: stiffnesses and damping are identified; otherwise the given values are exact, and only the motion is
  /// estimated. own_std: of each cylinder's oil against the common one, standard [-].
  explicit ModeIdentifier(double damping_ratio, bool learns = true,
                          const LogOil& own_std = LogOil::Constant(CylinderParameters::kStiffnessDeviation));

  /// Modes by the given stiffness at the present pose; call when Vibration finds new ones. The displacements and
  /// velocities of the joints and the identified values are kept. stiffer: logarithms of their oil's stiffness over the
  /// last ones'.
  void setModes(const BoomModes& given, const LogOil& stiffer = LogOil::Zero()) noexcept;
  /// Logarithms of each cylinder's stiffness over that of the modes given [-].
  LogOil oil() const noexcept;
  /// Covariance of the logarithms of two cylinders' stiffnesses [-].
  double oilCovariance(int one, int other) const noexcept { return covariance_(at(one, kOil), at(other, kOil)); }
  /// Advances by a step [s] under modal forces, see Vibration::advance().
  void advance(double step, const TorqueStep& modal) noexcept;
  /// Applies a blow, see Vibration::strike().
  void strike(const JointVector& impulse) noexcept;
  /// Resets the motion, as after a gap, and keeps the frequencies and damping. swing: standard deviation of each mode's
  /// displacement [m sqrt(kg)]; empty: not known.
  void forgetMotion(const JointVector& swing = {}) noexcept;
  /// Estimates the rock's force from now on. torque: joint torques per newton of it [N m/N]. Call at each pose.
  void followContact(const JointVector& torque) noexcept;
  /// Sets whether the rock bears on the hull, by the mean of that force.
  void bear(bool bears) noexcept { bears_ = bears; }
  /// Ends the estimate of the rock's force; the hull is free.
  void leaveContact() noexcept;
  /// Sets whether frequencies, damping and friction are kept while the motion is still estimated, as for a hammer at
  /// rest: no known force excites the boom then, and noise would be taken for soft oil.
  void keepOil(bool keep) noexcept { keeps_oil_ = keep; }
  /// Sets the lead of the crank's angle that the crank's model expects [s].
  void expectCrankLead(const CrankLead& lead) noexcept { expected_lead_ = lead, crank_lead_ = findCrankLead(); }
  /// Sets a cylinder's seals, whose friction acts on the modes. The part that is not known is estimated from then on.
  void setSeals(std::size_t cylinder, const Seals& seals) noexcept;
  /// Seals of a cylinder with the identified part of their friction as known.
  Seals withIdentified(std::size_t cylinder, Seals seals) const noexcept;
  /// Updates by readings of one instant and one clock, at the present time or a little before. Readings of channels
  /// outside of [0, kMaxChannels) and values that are not finite are ignored. A reading far from its prediction has
  /// less weight.
  void observe(const VibrationReading* readings, std::size_t count) noexcept;
  /// True if the accelerations agree with hammer, oil and, if it is estimated, the rock's force, or if they may still
  /// come to agree.
  bool explains() const noexcept { return explains_ || (learns_ && !seeks_ && explained_for_ <= kProven); }
  /// True once the accelerations have agreed with hammer and oil for five revolutions.
  bool isProven() const noexcept { return explained_for_ > kProven; }
  bool imuSpeaks() const noexcept;  ///< an IMU has sent readings of late
  bool imuStampsJitter() const noexcept { return jitterVariance(Clock::kImu, 0) > 0.0; }  ///< beyond its delay
  /// Time by which an IMU with early stamps must be read later [s].
  double waiting() const noexcept { return waiting_; }
  /// True if the identified oil is refuted: the caller gives modes of the nominal oil.
  bool forgets() const noexcept { return !explains_; }
  /// True if the caller must provide modes of the current estimate of the oil, even if it is uncertain.
  bool seeks() const noexcept { return seeks_; }
  /// True if the delay of the pressures relative to an IMU is identified; oil and delay look alike without one.
  bool isLagKnown() const noexcept { return isDelayFollowed(Clock::kPressures) && imuSpeaks(); }
  /// Mean square of the innovations of the oil torques over their variance, averaged over 1 s [-]. Correct pressures at
  /// 500 Hz have 0.3 to 0.7 (one of 20 machines briefly 1.2), pressures that lag by 5 ms have 1.2 and more. 0 without
  /// identification.
  double oilInnovationRatio() const noexcept { return learns_ ? oil_innovation_ratio_ : 0.0; }

  int channels() const noexcept { return channels_; }  ///< number of channels that have had a reading
  /// Frequency over the given one, and ratio of damping [-].
  double frequencyRatio(int mode) const noexcept { return ratio_[static_cast<std::size_t>(mode)]; }
  double damping(int mode) const noexcept { return damping_[static_cast<std::size_t>(mode)]; }
  double frequencyVariance(int mode) const noexcept;  ///< variance of the logarithm of the frequency [-]
  double dampingVariance(int mode) const noexcept;    ///< variance of the logarithm of the damping [-]
  double dampingDeviation(int mode) const noexcept { return std::sqrt(dampingVariance(mode)); }  ///< standard
  /// True if the frequency of every mode is known to 3 %, which is better than most given stiffnesses.
  bool identified() const noexcept;
  bool learns() const noexcept { return learns_; }
  /// True if frequencies and damping have yet to be identified together with the delay of a present IMU.
  bool waitsForDelay() const noexcept { return unlearns_for_ > 0.0 || (imuSpeaks() && !isDelayFollowed(Clock::kImu)); }
  /// Torque on a cylinder's joint by damping in excess of the given one, rms over an oscillation [N m]. The pressures
  /// do not contain it.
  double dampingWithoutOil(std::size_t cylinder) const noexcept;
  ModeState motion(int mode) const noexcept;  ///< estimated motion
  /// Modal torque of the oil that pressures show with a stamp this long [s] after the present, or before it if
  /// negative.
  double oilTorqueRead(int mode, double ahead) const noexcept;
  bool followsContact() const noexcept { return follows_contact_; }
  /// The rock's force [N]; a negative value is an estimation error.
  double contact() const noexcept { return state_[kContact]; }
  double contactDeviation() const noexcept { return std::sqrt(covariance_(kContact, kContact)); }  ///< standard [N]
  /// Delay of a clock's stamps [s]; 0 until it is estimated.
  double delay(Clock clock) const noexcept;
  /// Standard deviation [s]; larger where the delays of two clocks cannot be separated.
  double delayDeviation(Clock clock) const noexcept;
  /// Lead of the crank's angle by its model and the sensors [s].
  double crankLead() const noexcept { return crank_lead_; }
  /// Covariance of the errors of the modes' accelerations [m2 kg/s4].
  JointMatrix accelerationCovariance() const noexcept;

 private:
  static constexpr double kDelayDeviation = 2e-3;  ///< standard deviation of a delay that is not known [s]
  // Prior: kDelayDeviation
  static constexpr double kForcePart = 0.05;  ///< deviation of the modal force over its root mean square
  static constexpr double kForceTime = 0.01;  ///< correlation time of a force error [s]
  // Prior: kForcePart, kForceTime
  static constexpr int kSlots = kMaxChannels + kMaxJoints;  ///< offsets of channels, frictions of cylinders
  static constexpr int kDelays = kSlots, kContact = kDelays + 2, kModes = kContact + 2;  // of even places
  static constexpr int kMaxStates = kModes + 4 * kMaxJoints;
  using State = Eigen::Matrix<double, kMaxStates, 1>;
  using Covariance = Eigen::Matrix<double, kMaxStates, kMaxStates>;
  /// Some of the states.
  struct StateList {
    std::array<int, kMaxStates> states;  ///< the first of them
    int count{};
    void add(int state) noexcept { states[static_cast<std::size_t>(count++)] = state; }
    const int* begin() const noexcept { return states.data(); }
    const int* end() const noexcept { return states.data() + count; }
  };
  enum Part { kX, kV, kOil, kDamping, kParts };  ///< states of a mode; kOil: of the cylinder of the same number

  static constexpr int delayAt(Clock clock) noexcept { return kDelays + static_cast<int>(clock) - 1; }
  static constexpr int at(int mode, Part part) noexcept { return kModes + kParts * mode + part; }
  /// Offsets and frictions are stored from the modes downwards in the order of first use: one block is in use.
  int offsetAt(int channel) const noexcept { return slot_[static_cast<std::size_t>(channel)]; }
  int begin() const noexcept { return (kSlots - used_slots_) / 2 * 2; }  // an even place
  int end() const noexcept { return kModes + kParts * count_; }
  int states() const noexcept { return end() - begin(); }
  auto block() noexcept { return covariance_.block(begin(), begin(), states(), states()); }
  auto inUse(const State& state) const noexcept { return state.segment(begin(), states()); }

  ModeState stateOf(int mode) const noexcept { return {state_[at(mode, kX)], state_[at(mode, kV)]}; }
  double varianceWithoutOil(int mode) const noexcept;
  bool isDelayFollowed(Clock clock) const noexcept {
    return clock != Clock::kCrank && covariance_(delayAt(clock), delayAt(clock)) > 0.0;
  }
  double imuDelay() const noexcept { return state_[delayAt(Clock::kImu)]; }
  double pressureLag() const noexcept { return state_[delayAt(Clock::kPressures)]; }  ///< behind the IMU
  double delayByCrank(Clock clock) const noexcept {
    return clock == Clock::kCrank ? 0.0 : imuDelay() + (clock == Clock::kPressures ? pressureLag() : 0.0);
  }
  double delayVariance(Clock clock) const noexcept;
  /// Delay of a mode's oscillation in a clock's readings [s], in the sensors' time, and the amplitude that a hose
  /// leaves.
  struct Lag {
    double held{}, left{1.0};
  };
  using States = std::array<ModeState, kMaxJoints>;
  Lag lagOf(Clock clock, int mode) const noexcept;
  double torqueOf(int mode, const ModeState& of) const noexcept;
  double torqueRead(const Lag& lag, int mode, double ahead, const ModeHistory::Moment& then) const noexcept;
  void followHose(double step, const States& now, const States& next) noexcept;
  void correctHose(const State& by) noexcept;
  States statesNow() const noexcept;
  LogOil oilTorques(const States& of) const noexcept;
  ModeVector forceOfSeals(const LogOil& way) const noexcept;
  /// Torque of a cylinder's seals against its joint's motion, per unit of the friction's state [N m].
  LogOil sealTorques(const LogOil& way) const noexcept;
  LogOil wayOfSeals(double ahead) const noexcept;  ///< direction of each friction, see Seals
  double logFrequency(int mode) const noexcept;
  void advanceCovariance(double step, const std::array<ModeStep, kMaxJoints>& its, const States& now,
                         const States& next, const LogOil& way_next) noexcept;
  void setFirstGuesses() noexcept;
  void forgetOil() noexcept;
  void forget(int state, double deviation) noexcept;
  double rockOn(int mode) const noexcept { return follows_contact_ ? contact_[mode] : 0.0; }
  void applyForces(double step) noexcept;
  void advanceModes(const HeldForces::Piece& piece) noexcept;
  void applyBlow(const ModeVector& jump) noexcept;
  void addBlowToDelay(const ModeVector& force) noexcept;
  void walk(int mode, double step) noexcept;
  void walkContact(double step) noexcept;
  void advanceDelays(double step) noexcept;
  double findCrankLead() const noexcept;
  bool mayYetExplain() const noexcept;
  bool isExplained() const noexcept;
  /// Duration [s] of agreement, of lost frequencies, of inflated variances and of a hull without rock.
  static constexpr double kProven = look_back::kFiveTurns;
  double misfit() const noexcept {
    return std::max(1.0, oil_innovation_ratio_);
  }  ///< factor on the variance of the pressures
  double byDelay(Clock clock, const State& row) const noexcept;
  bool delayShows(Clock clock) const noexcept;
  StateList keptStates() const noexcept;
  struct Seen;
  using SeenModes = std::array<Seen, kMaxJoints>;
  /// Predicted reading, its rate, and its change by the second order of the instant's error.
  struct Predicted {
    double value{}, rate{}, bend{};
  };
  void update(const VibrationReading* readings, std::size_t count) noexcept;
  void excuseNoMoreThanRead(const VibrationReading& reading, double difference, State& row) const noexcept;
  void correct(const VibrationReading& reading, const State& row, double difference, const Predicted& predicted,
               const StateList& kept) noexcept;
  double gateReading(const VibrationReading& reading, double predicted, double difference) noexcept;
  void restoreKept(const StateList& kept, double moved, double S, const State& gain_S) noexcept;
  void limitPull(double step) noexcept;
  void transform(const JointMatrix& T) noexcept;
  void followDelay(Clock clock) noexcept;
  void unlearn(double part) noexcept;
  static bool counts(const VibrationReading& reading) noexcept;
  void useChannel(const VibrationReading& reading) noexcept;
  ModeHistory::Moment momentAt(int mode, double ahead) const noexcept;
  ModeHistory::Moment momentAhead(int mode, double ahead) const noexcept;
  Seen see(int mode, double ahead) const noexcept;
  Predicted findRow(const VibrationReading& reading, const SeenModes& modes, const std::optional<DrivenAround>& around,
                    State& row) const noexcept;
  double imuStampDeviation() const noexcept;
  double jitterVariance(Clock clock, int own) const noexcept;
  bool finite() const noexcept;
  void startAnew() noexcept;
  void useOil() noexcept;

  double damping_ratio_;
  double least_damping_, most_damping_;  ///< logarithms over the given one
  bool learns_, keeps_oil_{};
  LogOil own_std_;
  double known_for_{};  ///< time since every frequency has been known, until a delay is estimated [s]
  double lost_for_{};   ///< time for which a frequency has been lost since then [s]
  bool explains_{true}, seeks_{};
  double explained_for_{};            ///< time for which readings have agreed with the identified oil [s]
  double oil_innovation_ratio_{1.0};  ///< mean square of the oil torques' innovations over its expectation [-]
  double innovation_ratio_{1.0};      ///< mean square of the accelerations' innovations over its expectation [-]
  BoomModes modes_;
  ModeHistory history_;
  int count_{};
  bool follows_contact_{};
  ModeVector contact_ = ModeVector::Zero();  ///< modal force of the rock per newton
  bool bears_{};                             ///< the rock bears on the hull
  double free_for_{};                        ///< time for which it has not, while pressures were received [s]
  CrankLead expected_lead_;
  double crank_lead_{};
  double unlearns_for_{};      ///< remaining time of the inflated variances [s]
  double imu_age_{kInfinity};  ///< since the last reading of an IMU [s]
  HeldForces held_;
  std::optional<BehindHose> behind_hose_;  ///< torques behind the hoses, where they are followed
  double waiting_{};                       ///< time by which the sensors' time is behind the crank's stamps [s]
  std::optional<ModeVector> struck_;       ///< jump of the velocities by a blow at the present instant
  bool moving_known_{};                    ///< displacement and velocity belong to modes_
  State state_ = State::Zero();
  alignas(64) Covariance covariance_ = Covariance::Zero();  ///< aligned to cache lines: saves 10 % of a reading
  std::array<Seals, kMaxJoints> seals_;
  LogOil way_ = LogOil::Zero();  ///< see Seals
  /// Modal forces at the present time, and their rates.
  ModeVector force_ = ModeVector::Zero(), force_rate_ = force_;
  std::array<double, kMaxJoints> force_power_{};  ///< mean square of each modal force, over some seconds
  Mode modeAt(int mode) const noexcept { return {modes_.given_omega[mode] * frequencyRatio(mode), damping(mode)}; }

  std::array<double, kMaxJoints> ratio_{}, damping_{};  ///< ratios of frequency and of damping by state_
  LogOil stiffness_ratio_ = LogOil::Ones(), used_oil_ = LogOil::Zero();  ///< stiffness ratios; their logarithms
  std::array<double, kMaxJoints> used_frequency_{}, used_damping_{};     ///< logarithms of these
  int channels_{};                                                       ///< in use
  int used_slots_{};                                                     ///< by channels and frictions
  std::array<int, kMaxJoints> rubbing_at_{};      ///< state of each cylinder's friction; -1: not in use
  std::array<int, kMaxChannels> slot_{};          ///< state of each channel's offset; -1: not in use
  std::array<double, kMaxChannels> age_{};        ///< since the channel's last reading [s]
  std::array<Clock, kMaxChannels> clock_{};       ///< whose stamps it has
  std::array<TimingNoise, kMaxChannels> jitter_;  ///< jitter of its stamps, estimated by the channel
};

}  // namespace hammer_loads
