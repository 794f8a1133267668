/// Stiffness of each cylinder's oil and damping of the boom's modes, followed from what sensors see of its vibration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "hammer_loads/boom/behind_hose.h"
#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/covariance_kernels.h"
#include "hammer_loads/boom/held_forces.h"
#include "hammer_loads/boom/mode.h"
#include "hammer_loads/boom/mode_history.h"
#include "hammer_loads/boom/seals.h"
#include "hammer_loads/boom/vibration_reading.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/timing_noise.h"

namespace hammer_loads {

/// Time by which an angle is ahead of the crank [s], and its standard deviation.
struct CrankLead {
  double mean{}, deviation{};
};

/// Extended Kalman filter: per mode displacement, velocity and logarithm of damping over the given one; per cylinder
/// the logarithm of its oil's stiffness over that of the modes given; per channel an offset. Steps are those of
/// Vibration, with readings in any order between them. No allocation. Frequencies are of second order in the identified
/// stiffnesses, and shapes are those of the modes given; the caller therefore gives new modes before the stiffnesses
/// are far away.
///
/// First guesses: stiffnesses wrong by 30 % together and each beside by its own deviation, damping by a factor 1.6.
/// Forces on the boom are taken as wrong by 5 % of their root mean square over some 10 ms, independently.
///
/// A hull that bounces on rock moves as no hammer and no oil move it: while accelerations are twice as far off as they
/// should be, stiffnesses and damping are those given. Where no oil has explained them yet it is sought once more from
/// those given before that is said, with modes that follow it at once (seeks()): one cylinder that is much softer makes
/// other shapes. At first they wait until frequencies are known, since stamps that are late would lead them far away.
///
/// Stamps of sensors with a clock of their own may be late, each clock's by one time, a random walk. The filter lives
/// in the IMU's time: the hammer's forces and blows act later by its delay, which is what shows it; pressures are late
/// beside it by another. From 0.2 s on after the frequencies are known delays are followed, and for a second
/// frequencies and damping count as less known again. Their jitter about that, as behind a bus, is learned from the
/// residuals. A crank whose angle leads, as by a zero that is off, makes all sensors look late alike: what its model
/// expects of that (expectCrankLead()) is taken for the crank's, and the motion given in the sensors' time.
///
/// Where the rock's force may be followed its force is one more state, a random walk that a landing needs: by 10 kN in
/// 6 ms, in 1 ms where an IMU shows it. Pressures show the displacements; the force is what these need.
class ModeIdentifier {
 public:
  static constexpr int kMaxChannels = 12;
  static constexpr double kMostOil = 2.0;  ///< largest identified log stiffness: a frequency of e times the given one
  // Prior: kMostOil
  /// Remaining errors of log frequency and log damping of an identified mode: the links move in the hull, and bend.
  static constexpr double kLeftFrequency = 0.005, kLeftDamping = 0.1;
  // Prior: kLeftFrequency, kLeftDamping

  /// learns: stiffnesses and damping; else they are exact as given, and only the motion is followed. own_std: of
  /// each cylinder's oil against the common one, standard [-].
  explicit ModeIdentifier(double damping_ratio, bool learns = true,
                          const LogOil& own_std = LogOil::Constant(CylinderParameters::kStiffnessDeviation));

  /// Modes by the given stiffness at the present pose; call when Vibration finds new ones. Displacements and velocities
  /// of the joints carry over, and what is found. stiffer: logarithms of their oil's stiffness over the last ones'.
  void setModes(const BoomModes& given, const LogOil& stiffer = LogOil::Zero()) noexcept;
  /// Logarithms of each cylinder's stiffness over that of the modes given [-].
  LogOil oil() const noexcept;
  /// Covariance of the logarithms of two cylinders' stiffnesses [-].
  double oilCovariance(int one, int other) const noexcept { return covariance_(at(one, kOil), at(other, kOil)); }
  /// Over a step [s], as Vibration::advance(), by its modal forces.
  void advance(double step, const TorqueStep& modal) noexcept;
  /// Applies a blow, see Vibration::strike().
  void strike(const JointVector& impulse) noexcept;
  /// Vibration unknown, as after a gap; what is known of frequencies and damping stays. swing: how far each mode goes
  /// as a rule, standard [m sqrt(kg)]; empty: not known.
  void forgetMotion(const JointVector& swing = {}) noexcept;
  /// From now on a force of the rock is followed; torque: on the joints per newton of it [N m/N]. Call at each pose.
  void followContact(const JointVector& torque) noexcept;
  /// Sets whether the rock bears on the hull, by the mean of that force.
  void bear(bool bears) noexcept { bears_ = bears; }
  /// No more: the hull counts as free.
  void leaveContact() noexcept;
  /// Sets whether frequencies and damping are kept, whatever the next readings show; the motion is followed all the
  /// same. This is for a hammer at rest. No known force excites the boom then, and noise and the walk of the rock's
  /// force would be taken for soft oil, by a factor e of frequency in half a minute.
  void keepOil(bool keep) noexcept { keeps_oil_ = keep; }
  /// By how much time the crank's angle leads as far as its own model knows [s].
  void expectCrankLead(const CrankLead& lead) noexcept { expected_lead_ = lead, crank_lead_ = findCrankLead(); }
  /// Sets a cylinder's seals: the known part of their friction acts on the modes, the rest damps them.
  void setSeals(std::size_t cylinder, const Seals& seals) noexcept { seals_[cylinder] = seals; }
  /// Readings of one instant by one clock, at the present time or a little before. A channel in [0, kMaxChannels) keeps
  /// its offset; others, and values that are no number, do not count. A reading far off counts less. Three at a time,
  /// but each pressure by itself, are linear about what was known before them.
  void observe(const VibrationReading* readings, std::size_t count) noexcept;
  /// Accelerations are as hammer, oil and, where it is followed, the rock's force make them, or may yet turn out to be.
  bool explains() const noexcept { return explains_ || (learns_ && !seeks_ && explained_for_ <= kProven); }
  bool imuStampsJitter() const noexcept { return jitterVariance(Clock::kImu, 0) > 0.0; }  ///< beyond its delay
  /// By which the readings of an IMU are to be given later: its stamps are early [s].
  double waiting() const noexcept { return waiting_; }
  /// True if the identified oil is refuted: the caller gives modes of the nominal oil.
  bool forgets() const noexcept { return !explains_; }
  /// Give modes of the oil as it is found, known or not.
  bool seeks() const noexcept { return seeks_; }
  /// Returns true if the delay of the pressures is identified, against an IMU: alone they show delay and oil together.
  bool knowsLag() const noexcept { return isDelayFollowed(Clock::kPressures) && imuSpeaks(); }
  /// Mean square of the errors of predicted oil torques over their variance, of some 1 s [-]: right pressures at 500 Hz
  /// have 0.3 to 0.7, one of 20 machines 1.2 for a moment; those that lag by 5 ms 1.2 and more. 0 where nothing is
  /// learned.
  double oilSurprise() const noexcept { return learns_ ? oil_surprise_ : 0.0; }

  int modes() const noexcept { return count_; }
  int channels() const noexcept { return channels_; }  ///< number of channels that have had a reading
  /// Over the given frequency [-].
  double frequencyRatio(int mode) const noexcept { return ratio_[static_cast<std::size_t>(mode)]; }
  /// Ratio of damping [-].
  double damping(int mode) const noexcept { return damping_[static_cast<std::size_t>(mode)]; }
  double frequencyVariance(int mode) const noexcept;  ///< variance of the logarithm of the frequency [-]
  double dampingVariance(int mode) const noexcept;    ///< variance of the logarithm of the damping [-]
  double frequencyDeviation(int mode) const noexcept { return std::sqrt(frequencyVariance(mode)); }  ///< standard
  double dampingDeviation(int mode) const noexcept { return std::sqrt(dampingVariance(mode)); }      ///< standard
  /// Every mode's frequency is known to 3 %: better than most stiffnesses that are given.
  bool identified() const noexcept;
  bool learns() const noexcept { return learns_; }
  /// Frequencies and damping are yet to be found with the delay of an IMU that speaks.
  bool waitsForDelay() const noexcept { return unlearns_for_ > 0.0 || (imuSpeaks() && !isDelayFollowed(Clock::kImu)); }
  /// Torque on a cylinder's joint by damping beyond that given, rms of an oscillation [N m]; not in the pressures.
  double dampingBesideOil(std::size_t cylinder) const noexcept;
  ModeState motion(int mode) const noexcept;  ///< estimated motion
  /// Modal torque of the oil as pressures show it whose stamp is this time [s] after the present, or before it.
  double oilTorqueRead(int mode, double ahead) const noexcept;
  JointVector displacement() const noexcept;  ///< estimated displacement of the joints [rad]
  JointVector velocity() const noexcept;      ///< [rad/s]
  bool followsContact() const noexcept { return follows_contact_; }
  double contact() const noexcept { return state_[kContact]; }  ///< the rock's force [N]; below 0: an error
  double contactDeviation() const noexcept { return std::sqrt(covariance_(kContact, kContact)); }  ///< standard [N]
  /// By which a clock's stamps are late [s]; 0 as long as it is not followed.
  double delay(Clock clock) const noexcept;
  /// Standard [s]; less known where one clock's delay may be another's.
  double delayDeviation(Clock clock) const noexcept;
  /// By how much time the crank's angle leads, as its model expects and the sensors show [s].
  double crankLead() const noexcept { return crank_lead_; }
  /// Covariance of the errors of the modes' accelerations [m2 kg/s4].
  JointMatrix accelerationCovariance() const noexcept;

 private:
  static constexpr double kDelayDeviation = 2e-3;  ///< standard deviation of a delay that is not known [s]
  // Prior: kDelayDeviation
  static constexpr double kForcePart = 0.05;  ///< deviation of the modal force over its root mean square
  static constexpr double kForceTime = 0.01;  ///< for which a force stays wrong the same way [s]
  // Prior: kForcePart, kForceTime
  static constexpr int kDelays = kMaxChannels, kContact = kDelays + 2, kModes = kContact + 2;  // of even places
  static constexpr int kMaxStates = kModes + 4 * kMaxJoints;
  static_assert(kMaxStates <= kMostStates);
  using State = Eigen::Matrix<double, kMaxStates, 1>;
  using Covariance = Eigen::Matrix<double, kMaxStates, kMaxStates>;
  enum Part { kX, kV, kOil, kDamping, kParts };  ///< states of a mode; kOil: of the cylinder of the same number

  static constexpr int delayAt(Clock clock) noexcept { return kDelays + static_cast<int>(clock) - 1; }
  static constexpr int at(int mode, Part part) noexcept { return kModes + kParts * mode + part; }
  /// Offsets are taken from the modes downwards, in the order of use: what is in use is one block.
  int offsetAt(int channel) const noexcept { return slot_[static_cast<std::size_t>(channel)]; }
  int begin() const noexcept { return (kMaxChannels - channels_) / 2 * 2; }  // an even place
  int end() const noexcept { return kModes + kParts * count_; }
  int states() const noexcept { return end() - begin(); }
  auto block() noexcept { return covariance_.block(begin(), begin(), states(), states()); }
  auto inUse(const State& state) const noexcept { return state.segment(begin(), states()); }
  /// Covariances of a state with all.
  const double* column(int state) const noexcept { return &covariance_(0, state); }
  double* column(int state) noexcept { return &covariance_(0, state); }

  ModeState stateOf(int mode) const noexcept { return {state_[at(mode, kX)], state_[at(mode, kV)]}; }
  double besideOil(int mode) const noexcept;
  bool isDelayFollowed(Clock clock) const noexcept {
    return clock != Clock::kCrank && covariance_(delayAt(clock), delayAt(clock)) > 0.0;
  }
  double imuDelay() const noexcept { return state_[delayAt(Clock::kImu)]; }
  double pressureLag() const noexcept { return state_[delayAt(Clock::kPressures)]; }  ///< behind the IMU
  double delayByCrank(Clock clock) const noexcept {
    return clock == Clock::kCrank ? 0.0 : imuDelay() + (clock == Clock::kPressures ? pressureLag() : 0.0);
  }
  double delayVariance(Clock clock) const noexcept;
  /// Delay of a mode's oscillation in a clock's readings [s], by the sensors' time, and the amplitude that is left. A
  /// delay of pressures against an IMU comes from a hose: it delays by less than its time constant, and attenuates.
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
  ModeVector forceOfSeals(const States& of) const noexcept;
  double logFrequency(int mode) const noexcept;
  void advanceCovariance(double step, const std::array<ModeStep, kMaxJoints>& its, const States& now,
                         const States& next) noexcept;
  void setFirstGuesses() noexcept;
  void forgetOil() noexcept;
  void forget(int state, double deviation) noexcept;
  double rockOn(int mode) const noexcept { return follows_contact_ ? contact_[mode] : 0.0; }
  void takeForces(double step) noexcept;
  void advanceModes(const HeldForces::Piece& piece) noexcept;
  void takeBlow(const ModeVector& jump) noexcept;
  void addBlowToDelay(const ModeVector& force) noexcept;
  void walk(int mode, double step) noexcept;
  void walkContact(double step) noexcept;
  void advanceDelays(double step) noexcept;
  double findCrankLead() const noexcept;
  bool imuSpeaks() const noexcept;
  bool mayYetExplain() const noexcept;
  bool isExplained() const noexcept;
  /// [s]: of agreement with the oil, which does not change from one second to the next; of frequencies that were lost,
  /// or are unlearned; of a hull without rock, whose mean force has no longer memory.
  static constexpr double kProven = look_back::kFiveTurns;
  double misfit() const noexcept { return std::max(1.0, oil_surprise_); }  ///< factor on the variance of the pressures
  double byDelay(Clock clock, const State& row) const noexcept;
  bool delayShows(Clock clock) const noexcept;
  StateList keptStates() const noexcept;
  struct Seen;
  using SeenModes = std::array<Seen, kMaxJoints>;
  /// A reading; by the second; what its instant's deviation makes of it beside that.
  struct Predicted {
    double value{}, rate{}, bend{};
  };
  void take(const VibrationReading* readings, std::size_t count) noexcept;
  void excuseNoMoreThanRead(const VibrationReading& reading, double difference, State& row) const noexcept;
  void correct(const VibrationReading& reading, const State& row, double difference, const Predicted& predicted,
               const StateList& kept) noexcept;
  double weigh(const VibrationReading& reading, double predicted, double difference) noexcept;
  void takeBack(const StateList& kept, double moved, double S, const State& gain_S) noexcept;
  /// Change of all states if one of them moves by an amount.
  State movedWith(int state, double by) const noexcept {
    return by / covariance_(state, state) * covariance_.col(state);
  }
  void takeAsBearing(double step) noexcept;
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
  double known_for_{};  ///< time for which every frequency has been known, until a delay is followed [s]
  double lost_for_{};   ///< time for which one has not been since then [s]
  bool explains_{true}, seeks_{};
  double explained_for_{};    ///< time for which readings have agreed with the oil that was found [s]
  double oil_surprise_{1.0};  ///< mean square of the oil torques' errors over what it should be [-]
  double surprise_{1.0};      ///< mean square of accelerations' errors over what it should be [-]
  BoomModes modes_;
  ModeHistory history_;
  int count_{};
  bool follows_contact_{};
  ModeVector contact_ = ModeVector::Zero();  ///< modal force of the rock per newton
  bool bears_{};                             ///< the rock bears on the hull
  double free_for_{};                        ///< time for which it has not, while pressures came [s]
  CrankLead expected_lead_;
  double crank_lead_{};
  double unlearns_for_{};      ///< time for which what was found still counts as less known [s]
  double imu_age_{kInfinity};  ///< since the last reading of an IMU [s]
  HeldForces held_;
  std::optional<BehindHose> behind_hose_;  ///< torques behind the hoses, where they are followed
  double waiting_{};                       ///< by which the sensors' time is behind the crank's stamps [s]
  std::optional<ModeVector> struck_;       ///< by a blow that has just been: of the velocities
  bool moving_known_{};                    ///< displacement and velocity belong to modes_
  State state_ = State::Zero();
  alignas(64) Covariance covariance_ = Covariance::Zero();  ///< aligned to cache lines: saves 10 % of a reading
  std::array<Seals, kMaxJoints> seals_;
  /// Modal, at the present time; and by the second.
  ModeVector force_ = ModeVector::Zero(), force_rate_ = force_;
  std::array<double, kMaxJoints> force_power_{};  ///< mean square of each modal force, over some seconds
  Mode modeAt(int mode) const noexcept { return {modes_.given_omega[mode] * frequencyRatio(mode), damping(mode)}; }

  std::array<double, kMaxJoints> ratio_{}, damping_{};  ///< ratios of frequency and of damping by state_
  LogOil stiffness_ratio_ = LogOil::Ones(), used_oil_ = LogOil::Zero();  ///< stiffness ratios; their logarithms
  std::array<double, kMaxJoints> used_frequency_{}, used_damping_{};     ///< logarithms of these
  int channels_{};                                                       ///< in use
  std::array<int, kMaxChannels> slot_{};          ///< state of each channel's offset; -1: not in use
  std::array<double, kMaxChannels> age_{};        ///< since the channel's last reading [s]
  std::array<Clock, kMaxChannels> clock_{};       ///< whose stamps it has
  std::array<TimingNoise, kMaxChannels> jitter_;  ///< jitter of its stamps, as the channel shows it
};

}  // namespace hammer_loads
