// Updates by readings: their prediction from the modes, and the correction of modes and oil.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kFarOff = gate::kRare;  // standard deviations beyond which a reading counts less
constexpr double kRatioShare = 3e-4;     // weight of one reading in the mean of squares: 1.7 s at 1 kHz
constexpr double kContradicted =
    5.0;  // limit of that mean: at 4, the oil was identified wrongly in one of eight poses on rock
constexpr double kAgrees = 1.8;                            // limit of that mean for agreement
constexpr double kWorstRatio = square(gate::kImpossible);  // limit of the contribution of one reading
constexpr std::size_t kTogether = 3;                       // readings that are linear about one state

}  // namespace

void ModeIdentifier::useChannel(const VibrationReading& reading) noexcept {
  const auto i = static_cast<std::size_t>(reading.channel);
  const double first = square(reading.offset_std), walk = square(reading.offset_walk);
  if (slot_[i] < 0) {
    ++channels_;
    slot_[i] = kSlots - ++used_slots_;
    covariance_(slot_[i], slot_[i]) = first;
  } else {
    double& variance = covariance_(slot_[i], slot_[i]);
    variance = std::min(variance + walk * age_[i], std::max(variance, first + walk));
  }
  age_[i] = 0.0;
  clock_[i] = reading.clock;
}

double ModeIdentifier::torqueOf(int mode, const ModeState& of) const noexcept {
  const Mode m = modeAt(mode);
  return m.omega * (m.omega * of.x + 2.0 * m.zeta * of.v);
}

double ModeIdentifier::oilTorqueRead(int mode, double ahead) const noexcept {
  const Lag lag = lagOf(Clock::kPressures, mode);
  return torqueRead(lag, mode, ahead, momentAt(mode, ahead + waiting_ - lag.held));
}

/// Oil torque in pressures whose stamp is this time after the present. then: the mode at the instant whose oscillation
/// they show.
double ModeIdentifier::torqueRead(const Lag& lag, int mode, double ahead,
                                  const ModeHistory::Moment& then) const noexcept {
  if (behind_hose_ && lag.left < 1.0)
    return behind_hose_->at(mode, ahead + waiting_, pressureLag(), torqueOf(mode, stateOf(mode)));
  const double force = then.force + rockOn(mode) * state_[kContact], torque = torqueOf(mode, then.state);
  return force + lag.left * (torque - force);
}

/// Mode at the instant of a reading. by_oil: decrease of its acceleration per unit of each logarithm of stiffness.
struct ModeIdentifier::Seen {
  ModeHistory::Moment then;
  std::array<double, kMaxJoints> by_oil, by_rubbing;
  double acceleration, stiff, damped, rock;
  double cosine, sine;  ///< derivatives of the state then by the displacement and velocity of now
  double read{};        ///< predicted reading of the oil's torque
  double left{1.0},
      fades_by{};  ///< amplitude of an oscillation behind a hose, and its relative decrease per second of delay
};

ModeIdentifier::Seen ModeIdentifier::see(int mode, double ahead) const noexcept {
  const Mode m = modeAt(mode);
  Seen seen;
  seen.then = momentAt(mode, ahead);
  seen.stiff = m.omega * m.omega, seen.damped = 2.0 * m.zeta * m.omega, seen.rock = rockOn(mode);
  seen.acceleration =
      seen.then.force + seen.rock * state_[kContact] - seen.damped * seen.then.state.v - seen.stiff * seen.then.state.x;
  const double turned = seen.stiff * square(ahead);
  seen.sine = ahead * (1.0 - turned / 6.0), seen.cosine = 1.0 - 0.5 * turned;
  return seen;
}

/// Prediction of the reading.
ModeIdentifier::Predicted ModeIdentifier::findRow(const VibrationReading& reading, const SeenModes& modes,
                                                  const std::optional<DrivenAround>& around,
                                                  State& row) const noexcept {
  row.setZero();
  const int offset = offsetAt(reading.channel);
  double predicted = state_[offset], late = 0.0, of_force = 0.0, bend = 0.0;
  for (int k = 0; k < count_; ++k) {
    double by_x = 0.0, by_v = 0.0, by_a = 0.0, by_oil = 0.0;  // per modal displacement, velocity, acceleration
    for (int i = 0; i < count_; ++i) {
      const int joint = modes_.joint[static_cast<std::size_t>(i)];
      if (reading.of_oil) {
        by_oil += reading.oil[joint] * modes_.inertia(joint, k);
        continue;
      }
      const double shape = modes_.shape(i, k);
      by_x += reading.displacement[joint] * shape;
      by_v += reading.velocity[joint] * shape;
      by_a += reading.acceleration[joint] * shape;
    }
    const Seen& seen = modes[static_cast<std::size_t>(k)];
    const ModeState& then = seen.then.state;
    const double whole = by_oil,
                 lost = by_oil * (1.0 - seen.left);  // of the oscillation about the forces, which the hose transmits
    by_oil *= seen.left;
    const double held = by_oil - by_a, damped = seen.damped * then.v, stiff = seen.stiff * then.x;
    const double of_x = by_x + held * seen.stiff, of_v = by_v + held * seen.damped;
    const double torque = stiff + damped, force = torque + seen.acceleration;
    predicted += by_x * then.x + by_v * then.v + by_a * seen.acceleration + whole * seen.read;
    const double driven =
        around ? by_a * around->force_rate[k] + of_v * around->velocity_rate[k] : by_a * seen.then.force_rate;
    if (around) bend += by_a * around->force_bend[k] + of_v * around->velocity_bend[k];
    of_force += driven;
    late += square(seen.left) * (of_x * then.v + of_v * seen.acceleration) + driven +
            seen.fades_by * by_oil * (torque - force);
    row[kContact] += (by_a + lost) * seen.rock;
    row[at(k, kX)] = seen.cosine * of_x - seen.stiff * seen.sine * of_v;
    row[at(k, kV)] = seen.cosine * of_v + seen.sine * of_x;
    for (int i = 0; i < count_; ++i) row[at(i, kOil)] += held * seen.by_oil[static_cast<std::size_t>(i)];
    row[at(k, kDamping)] = held * damped;
    for (int i = 0; i < count_; ++i) {
      const int rubs = rubbing_at_[static_cast<std::size_t>(i)];
      if (rubs >= 0) row[rubs] += by_a * seen.by_rubbing[static_cast<std::size_t>(i)];
    }
  }
  row[offset] = 1.0;
  if (reading.clock == Clock::kPressures) row[delayAt(Clock::kPressures)] = -late;
  if (reading.clock == Clock::kImu) row[delayAt(Clock::kImu)] = -of_force;
  if (reading.clock == Clock::kCrank) row[delayAt(Clock::kImu)] = late;
  return {predicted, late, bend};
}

void ModeIdentifier::observe(const VibrationReading* readings, std::size_t count) noexcept {
  if (!moving_known_ || count == 0 || !history_.reaches(-readings->ahead - waiting_)) return;
  const Clock clock = readings->clock;
  const double since_imu = imu_age_;
  if (clock == Clock::kImu) imu_age_ = 0.0;
  if (clock != Clock::kCrank) followDelay(clock);
  for (std::size_t r = 0; r < count; ++r)  // all of them first, since a new one enlarges the block of states in use
    if (counts(readings[r])) useChannel(readings[r]);
  const State known = state_;
  // An oil torque is a product of stiffness and displacement; linearising three of them about one state increases the
  // error by a tenth.
  const std::size_t together = clock == Clock::kPressures ? 1 : kTogether;
  for (std::size_t first = 0; first < count; first += together) {
    if (first > 0 && learns_) useOil();  // by the reading before
    update(readings + first, std::min(together, count - first));
  }
  correctHose(state_ - known);
  if (clock == Clock::kImu) limitPull(since_imu);
  if (learns_ && !explains_) forgetOil();
  if (!state_.segment(begin(), states()).allFinite()) return startAnew();
  if (learns_) useOil();
  if (clock != Clock::kCrank) crank_lead_ = findCrankLead();
}

/// Corrects a rock force that pulls. Rock only pushes: a pull that exceeds its deviation and lasts longer than a force
/// error stems from offsets and from the pose. If the pressures lag more than clocks do, it stems from the attenuation
/// by a hose.
void ModeIdentifier::limitPull(double step) noexcept {
  if (!follows_contact_ || pressureLag() > kDelayDeviation) return;
  const double pulls = -contactDeviation() - state_[kContact];
  if (!(pulls > 0.0)) return;
  const double by = std::min(1.0, step / kForceTime) * pulls;
  State moved = by / covariance_(kContact, kContact) * covariance_.col(kContact);
  moved.segment<2>(kDelays).setZero();
  for (int k = 0; k < count_; ++k) moved[at(k, kOil)] = moved[at(k, kDamping)] = 0.0;
  for (const int rubs : rubbing_at_)
    if (rubs >= 0) moved[rubs] = 0.0;
  state_ += moved;
}

bool ModeIdentifier::counts(const VibrationReading& reading) noexcept {
  return reading.channel >= 0 && reading.channel < kMaxChannels && std::isfinite(reading.value);
}

/// Limits the uncertainty of a torque by an unknown stiffness to the torque that was read. The uncertainty is
/// proportional to the torque. A motion that an IMU has made wrong would otherwise be accepted because of the large
/// torque that it predicts.
void ModeIdentifier::excuseNoMoreThanRead(const VibrationReading& reading, double difference,
                                          State& row) const noexcept {
  if (!reading.of_oil || !keeps_oil_ || !imuSpeaks() || !exceeds(difference, square(reading.noise), kFarOff)) return;
  const double read = reading.value - state_[offsetAt(reading.channel)], predicted = read - difference;
  const double part = std::clamp(read / predicted, 0.0, 1.0);
  for (int i = 0; i < count_; ++i) row[at(i, kOil)] *= part;
}

/// Finds the rows of all readings about one state, then updates by one reading after the other.
void ModeIdentifier::update(const VibrationReading* readings, std::size_t count) noexcept {
  SeenModes seen;
  States then;
  for (int k = 0; k < count_; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const Lag lag = lagOf(readings->clock, k);
    seen[mode] = see(k, readings->ahead + waiting_ - lag.held);
    seen[mode].left = lag.left;
    if (readings->of_oil) seen[mode].read = torqueRead(lag, k, readings->ahead, seen[mode].then);
    if (lag.left < 1.0) seen[mode].fades_by = pressureLag() * seen[mode].stiff * square(lag.left);
    then[mode] = seen[mode].then.state;
  }
  std::optional<DrivenAround> around;
  if (readings->clock == Clock::kImu)
    around = drivenAround(history_, held_, force_, readings->ahead + waiting_, imuStampDeviation());
  const LogOil way = wayOfSeals(readings->ahead + waiting_);
  const LogOil torque = oilTorques(then), seals = sealTorques(way);
  const ModeVector rubbed = forceOfSeals(way);
  for (int k = 0; k < count_; ++k) {
    Seen& its = seen[static_cast<std::size_t>(k)];
    its.acceleration += rubbed[k];
    for (int i = 0; i < count_; ++i) {
      its.by_oil[static_cast<std::size_t>(i)] =
          modes_.shape(i, k) * torque[i] + 0.5 * modes_.oil_share(i, k) * its.damped * its.then.state.v;
      its.by_rubbing[static_cast<std::size_t>(i)] = -modes_.shape(i, k) * seals[i];
    }
  }
  std::array<State, kTogether> row;
  std::array<double, kTogether> difference;  // of the value from what is predicted
  std::array<Predicted, kTogether> predicted;
  for (std::size_t r = 0; r < count; ++r) {
    if (!counts(readings[r])) continue;
    predicted[r] = findRow(readings[r], seen, around, row[r]);
    difference[r] = readings[r].value - predicted[r].value;
    excuseNoMoreThanRead(readings[r], difference[r], row[r]);
  }
  const StateList kept = keptStates();
  const State before = state_;
  for (std::size_t r = 0; r < count; ++r)
    if (counts(readings[r]))
      correct(readings[r], row[r], difference[r] - inUse(row[r]).dot(inUse(state_) - inUse(before)), predicted[r],
              kept);
}

void ModeIdentifier::correct(const VibrationReading& reading, const State& row, double difference,
                             const Predicted& predicted, const StateList& kept) noexcept {
  const double rate = predicted.rate;
  State gain_S;
  gain_S.segment(begin(), states()).noalias() = block() * inUse(row);
  TimingNoise& jitter = jitter_[static_cast<std::size_t>(reading.channel)];
  const double by_stamp = byDelay(reading.clock, row) + square(rate) * jitterVariance(reading.clock, reading.channel) +
                          2.0 * square(predicted.bend);
  const double S = gateReading(reading, inUse(row).dot(inUse(gain_S)) + by_stamp, difference);
  if (isDelayFollowed(reading.clock) && S > 0.0) jitter.learn(difference, S, rate);
  if (!(S > 0.0)) return;
  state_.segment(begin(), states()) += difference / S * inUse(gain_S);
  auto P = block();
  const auto column = inUse(gain_S);
  const double by = 1.0 / S;
  for (Eigen::Index j = 0; j < P.cols(); ++j) P.col(j) -= by * column[j] * column;
  restoreKept(kept, difference / S, S, gain_S);
}

/// True while the errors of the accelerations may stem from an oil that is not identified yet or from late stamps.
bool ModeIdentifier::mayYetExplain() const noexcept {
  return learns_ && !(identified() && (isDelayFollowed(Clock::kImu) || explained_for_ > kProven));
}

/// True if the identified oil explains the accelerations.
bool ModeIdentifier::isExplained() const noexcept {
  return explains_ && innovation_ratio_ < kAgrees && learns_ && identified();
}

/// Innovation variance S of a reading from the variance of its prediction; 0 if the reading is ignored.
double ModeIdentifier::gateReading(const VibrationReading& reading, double predicted, double difference) noexcept {
  const double S = predicted + square(reading.noise) + square(reading.neglected);
  if (!(S > 0.0) || !std::isfinite(S) || !std::isfinite(difference)) return 0.0;
  if (!reading.of_oil && reading.acceleration.squaredNorm() > 0.0) {
    if (explains_) {
      explains_ = innovation_ratio_ < kContradicted || mayYetExplain();
    } else if (innovation_ratio_ < kAgrees) {
      explains_ = true, seeks_ = false;
    }
    innovation_ratio_ +=
        kRatioShare * (std::min(kWorstRatio, square(difference) / (S - square(reading.neglected))) - innovation_ratio_);
  }
  if (reading.of_oil)
    oil_innovation_ratio_ += kRatioShare * (std::min(kWorstRatio, square(difference) / S) - oil_innovation_ratio_);
  if (!(square(difference) > square(kFarOff) * S)) return S;
  return S * std::abs(difference) / (kFarOff * std::sqrt(S));
}

/// States that readings are not to change.
ModeIdentifier::StateList ModeIdentifier::keptStates() const noexcept {
  StateList kept;
  if (!learns_) return kept;
  for (int k = 0; keeps_oil_ && k < count_; ++k) kept.add(at(k, kOil)), kept.add(at(k, kDamping));
  for (const int rubs : rubbing_at_)
    if (keeps_oil_ && rubs >= 0) kept.add(rubs);
  if (keeps_oil_) kept.add(delayAt(Clock::kImu));
  if (keeps_oil_ || !delayShows(Clock::kPressures)) kept.add(delayAt(Clock::kPressures));
  return kept;
}

/// Reverts the correction of these states. The other states are corrected with these taken as uncertain as before
/// (Schmidt-Kalman filter).
void ModeIdentifier::restoreKept(const StateList& kept, double moved, double S, const State& gain_S) noexcept {
  for (int i : kept) {
    state_[i] -= moved * gain_S[i];
    for (int j : kept) covariance_(i, j) += gain_S[i] * gain_S[j] / S;
  }
}

}  // namespace hammer_loads
