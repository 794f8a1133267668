// Readings: what a sensor shows of the modes, and what that says of their oil.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/growth.h"
#include "hammer_loads/util/known_count.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kFarOff = 3.0;                         // standard deviations beyond which a reading counts less
constexpr double kMostRatio = 1.0;                      // of log frequency: e
constexpr double kMostEarly = 0.004, kMostLate = 0.01;  // [s]
constexpr double kSurpriseShare = 3e-4;                 // of one acceleration in the mean of squares: 1.7 s at 1 kHz
constexpr double kSurprised = 5.0, kCalm = 1.8;         // of that mean, over what it should be
constexpr double kOilSurpriseShare = 5e-4;              // of one oil torque: 1.3 s of three at 500 Hz
constexpr double kWorstSurprise = 25.0;                 // what one can add at most

}  // namespace

void ModeIdentifier::useChannel(const VibrationReading& reading) noexcept {
  const auto i = static_cast<std::size_t>(reading.channel);
  const double first = square(reading.offset_deviation), walk = square(reading.offset_walk);
  if (slot_[i] < 0) {
    ++channels_;
    slot_[i] = kMaxChannels - channels_;
    covariance_(slot_[i], slot_[i]) = first;
  } else {
    double& variance = covariance_(slot_[i], slot_[i]);
    variance = std::min(variance + walk * age_[i], std::max(variance, first + walk));
  }
  age_[i] = 0.0;
}

/// By the hammer and, where it is followed, the rock.
double ModeIdentifier::accelerationNow(int mode) const noexcept {
  return acceleration(modeAt(mode), stateOf(mode), force_[mode] + rockOn(mode) * state_[kContact]);
}

/// By a short line back: some 1e-4 of it for 0.5 ms of the fastest mode.
ModeState ModeIdentifier::motion(int mode) const noexcept {
  const Mode m = modeAt(mode);
  const ModeState now = stateOf(mode);
  const double back = crankLead(), a = accelerationNow(mode);
  const double jerk = force_rate_[mode] - 2.0 * m.zeta * m.omega * a - square(m.omega) * now.v;
  return {now.x - back * (now.v - 0.5 * back * a), now.v - back * (a - 0.5 * back * jerk)};
}

/// By the crank's time.
void ModeIdentifier::findMotion(int mode, double ahead, ModeThen& then) const noexcept {
  const ModeState now = stateOf(mode);
  ModeHistory::Place place;
  if (ahead < 0.0 && history_.find(-ahead, place)) return history_.find(mode, place, modeAt(mode).omega, now, then);
  then.motion = {now.x + ahead * now.v, now.v + ahead * accelerationNow(mode)};
  then.force = force_[mode] + ahead * force_rate_[mode];
  then.force_rate = force_rate_[mode];
}

/// Of a mode, for readings of one instant.
struct ModeIdentifier::Seen {
  ModeThen then;
  double acceleration, stiff, damped;
  double cosine, sine;  ///< of what was then: how displacement and velocity of now show in it
};

void ModeIdentifier::see(int mode, double ahead, Seen& seen) const noexcept {
  const Mode m = modeAt(mode);
  findMotion(mode, ahead, seen.then);
  seen.acceleration =
      hammer_loads::acceleration(m, seen.then.motion, seen.then.force + rockOn(mode) * state_[kContact]);
  seen.stiff = m.omega * m.omega, seen.damped = 2.0 * m.zeta * m.omega;
  const double turned = seen.stiff * square(ahead);
  seen.sine = ahead * (1.0 - turned / 6.0), seen.cosine = 1.0 - turned / 2.0;
}

/// What is predicted of the reading.
double ModeIdentifier::findRow(const VibrationReading& reading, const SeenModes& modes, State& row) const noexcept {
  clear(row);
  row[offsetAt(reading.channel)] = 1.0;
  double predicted = state_[offsetAt(reading.channel)];
  double late = 0.0;
  withCount<3>(count_, [&](auto count) {
    for (int k = 0; k < count; ++k) {
      double by_x = 0.0, by_v = 0.0, by_a = 0.0, by_oil = 0.0;  // per modal displacement, velocity, acceleration
      for (int i = 0; i < count; ++i) {
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
      const ModeState& s = seen.then.motion;
      const double held = by_oil - by_a, damped = seen.damped * s.v;
      const double of_x = by_x + held * seen.stiff, of_v = by_v + held * seen.damped;
      predicted += by_x * s.x + by_v * s.v + by_a * seen.acceleration + by_oil * (seen.stiff * s.x + damped);
      late += of_x * s.v + of_v * seen.acceleration + by_a * seen.then.force_rate;
      row[kContact] += by_a * rockOn(k);
      row[at(k, kX)] = seen.cosine * of_x - seen.stiff * seen.sine * of_v;
      row[at(k, kV)] = seen.cosine * of_v + seen.sine * of_x;
      row[at(k, kFrequency)] = held * (2.0 * seen.stiff * s.x + damped);
      row[at(k, kDamping)] = held * damped;
    }
  });
  if (reading.clock != Clock::kCrank) row[delayAt(reading.clock)] = -late;
  return predicted;
}

/// Rows of readings about one state, and P row^T of each, which becomes that after those before it.
struct ModeIdentifier::Rows {
  alignas(64) std::array<State, kMostAtOnce> row, gain_S;
  std::array<double, kMostAtOnce> difference;  ///< of the value from what is predicted
  std::array<int, kMostAtOnce> offset;
  std::array<const VibrationReading*, kMostAtOnce> reading;
  std::size_t count{};
};

/// What they have shown and the covariance has not lost yet: the sum of column column^T/S. moved: so many of its column
/// were added to the state.
struct ModeIdentifier::Shown {
  alignas(64) std::array<State, 4 * kMostAtOnce> column;
  std::array<double, 4 * kMostAtOnce> S, moved;
  std::size_t count{};
  State& add(double its_S, double its_moved) noexcept {
    S[count] = its_S, moved[count] = its_moved;
    return column[count++];
  }
};

void ModeIdentifier::observe(const VibrationReading* readings, std::size_t count) noexcept {
  if (!moving_known_ || count == 0) return;
  const Clock clock = readings->clock;
  if (clock == Clock::kImu) imu_age_ = 0.0;
  if (clock != Clock::kCrank) followDelay(clock);
  for (std::size_t r = 0; r < count; ++r)  // all of them first: a new one makes the block of what is in use larger
    if (counts(readings[r])) useChannel(readings[r]);
  // An oil torque is a product of stiffness and displacement: three of them about one state cost a tenth of accuracy.
  const std::size_t together = clock == Clock::kPressures ? 1 : kMostAtOnce;
  Shown shown;
  for (std::size_t first = 0; first < count; first += together) {
    if (first > 0 && learns_) useOil();  // what the one before has shown
    take(readings + first, std::min(together, count - first), shown);
    if (shown.count + 2 * kMostAtOnce > shown.S.size()) subtract(shown);
  }
  subtract(shown);
  if (clock != Clock::kCrank) takeAsLate(clock);
  if (learns_ && !explains_) forgetOil();
  if (!state_.segment(begin(), states()).allFinite()) return startAnew();
  if (learns_) useOil();
  if (clock != Clock::kCrank) crank_lead_ = findCrankLead();
}

bool ModeIdentifier::counts(const VibrationReading& reading) noexcept {
  return reading.channel >= 0 && reading.channel < kMaxChannels && std::isfinite(reading.value);
}

/// One reading after the other: its P row^T is that of the covariance as it stands, less what those before it have
/// shown.
void ModeIdentifier::take(const VibrationReading* readings, std::size_t count, Shown& shown) noexcept {
  Rows rows;
  findRows(readings, count, rows);
  if (rows.count == 0) return;
  timesRows(block(), static_cast<int>(rows.count), rows.row[0].data(), kDelays, rows.offset.data(),
            rows.gain_S[0].data());
  const Kept kept = keptStates();
  const std::size_t first = shown.count;  // shown before the rows were found: the state has it already
  for (std::size_t r = 0; r < rows.count; ++r) {
    State& gain_S = rows.gain_S[r];
    double difference = rows.difference[r];
    for (std::size_t k = 0; k < shown.count; ++k) {
      const double seen = dot(shown.column[k], rows.row[r]);
      add(-seen / shown.S[k], shown.column[k], gain_S);
      if (k >= first) difference -= shown.moved[k] * seen;
    }
    const double S = weigh(*rows.reading[r], dot(gain_S, rows.row[r]), difference);
    if (!(S > 0.0)) continue;
    add(difference / S, gain_S, state_);
    copy(gain_S, shown.add(S, difference / S));
    if (kept.count > 0) takeBack(kept, difference / S, S, gain_S, shown);
  }
}

void ModeIdentifier::subtract(Shown& shown) noexcept {
  for (std::size_t k = 0; k < shown.count; k += kMostAtOnce)
    subtractSquares(block(), static_cast<int>(std::min<std::size_t>(kMostAtOnce, shown.count - k)),
                    shown.column[k].data(), &shown.S[k]);
  shown.count = 0;
}

void ModeIdentifier::findRows(const VibrationReading* readings, std::size_t count, Rows& rows) const noexcept {
  SeenModes seen;
  for (int k = 0; k < count_; ++k)
    see(k, readings->ahead - delayByCrank(readings->clock), seen[static_cast<std::size_t>(k)]);
  for (const VibrationReading* reading = readings; reading < readings + count; ++reading) {
    if (!counts(*reading)) continue;
    rows.difference[rows.count] = reading->value - findRow(*reading, seen, rows.row[rows.count]);
    rows.offset[rows.count] = offsetAt(reading->channel);
    rows.reading[rows.count++] = reading;
  }
}

/// S of a reading, by the variance of what is predicted; 0: it does not count.
double ModeIdentifier::weigh(const VibrationReading& reading, double predicted, double difference) noexcept {
  const double S = predicted + square(reading.noise) + square(reading.neglected);
  if (!(S > 0.0) || !std::isfinite(S) || !std::isfinite(difference)) return 0.0;
  if (!reading.of_oil && reading.acceleration.squaredNorm() > 0.0) {
    explains_ = explains_ ? surprise_ < kSurprised || (learns_ && !identified()) : surprise_ < kCalm;
    surprise_ +=
        kSurpriseShare * (std::min(kWorstSurprise, square(difference) / (S - square(reading.neglected))) - surprise_);
  }
  if (reading.of_oil)
    oil_surprise_ += kOilSurpriseShare * (std::min(kWorstSurprise, square(difference) / S) - oil_surprise_);
  if (!(square(difference) > square(kFarOff) * S)) return S;
  return S * std::abs(difference) / (kFarOff * std::sqrt(S));
}

/// States that readings are not to change.
ModeIdentifier::Kept ModeIdentifier::keptStates() const noexcept {
  Kept kept;
  if (!learns_) return kept;
  for (int k = 0; keeps_oil_ && k < count_; ++k) kept.add(at(k, kFrequency)), kept.add(at(k, kDamping));
  if (keeps_oil_) kept.add(delayAt(Clock::kImu));
  if (keeps_oil_ || !delayShows(Clock::kPressures)) kept.add(delayAt(Clock::kPressures));
  return kept;
}

/// What a reading has shown of these. The rest counts it as with them not known better (Schmidt-Kalman filter).
void ModeIdentifier::takeBack(const Kept& kept, double moved, double S, const State& gain_S, Shown& shown) noexcept {
  State& its_part = shown.add(-S, -moved);
  clear(its_part);
  for (int i : kept) {
    its_part[i] = gain_S[i];
    state_[i] -= moved * gain_S[i];
  }
}

/// Of the states in use.
double ModeIdentifier::dot(const State& a, const State& b) const noexcept {
  Lane sum = Lane::Zero();
  for (int i = begin(); i < end(); i += kLane) sum += lane(&a[i]) * lane(&b[i]);
  return sum.sum();
}

void ModeIdentifier::add(double factor, const State& what, State& to) const noexcept {
  for (int i = begin(); i < end(); i += kLane) lane(&to[i]) += factor * lane(&what[i]);
}

void ModeIdentifier::copy(const State& from, State& to) const noexcept {
  for (int i = begin(); i < end(); i += kLane) lane(&to[i]) = lane(&from[i]);
}

void ModeIdentifier::clear(State& state) const noexcept {
  for (int i = begin(); i < end(); i += kLane) lane(&state[i]).setZero();
}

void ModeIdentifier::forgetOil() noexcept {
  forget(kDelays, 0.0), forget(kDelays + 1, 0.0);
  least_delay_ = {};
  known_for_ = lost_for_ = crank_lead_ = 0.0;
  for (int k = 0; k < kMaxJoints; ++k) {
    forget(at(k, kFrequency), 0.0);
    forget(at(k, kDamping), 0.0);
  }
  ratio_.fill(1.0), used_frequency_.fill(0.0);
  damping_.fill(damping_ratio_), used_damping_.fill(0.0);
  setFirstGuesses();
}

/// Frequencies, damping and delay of the state, within bounds.
void ModeIdentifier::useOil() noexcept {
  for (int k = 0; k < count_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    double &frequency = state_[at(k, kFrequency)], &damping = state_[at(k, kDamping)];
    frequency = std::clamp(frequency, -kMostRatio, kMostRatio);
    damping = std::clamp(damping, least_damping_, most_damping_);
    ratio_[i] *= growth(frequency - used_frequency_[i]), used_frequency_[i] = frequency;
    damping_[i] *= growth(damping - used_damping_[i]), used_damping_[i] = damping;
  }
  for (int i : {kDelays, kDelays + 1}) state_[i] = std::clamp(state_[i], -kMostEarly, kMostLate);
}

}  // namespace hammer_loads
