// Readings: what a sensor shows of the modes, and what that says of their oil.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/four_modes.h"
#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/avx2.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kFarOff = 3.0;                  // standard deviations beyond which a reading counts less
constexpr double kSurpriseShare = 3e-4;          // of one acceleration in the mean of squares: 1.7 s at 1 kHz
constexpr double kSurprised = 5.0, kCalm = 1.8;  // of that mean, over what it should be
constexpr double kOilSurpriseShare = 5e-4;       // of one oil torque: 1.3 s of three at 500 Hz
constexpr double kWorstSurprise = 25.0;          // what one can add at most

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

/// Of modes first to the third after it, by the crank's time.
HAMMER_LOADS_INLINE void ModeIdentifier::findMotions(int first, double ahead, FourModes& then) const noexcept {
  // One by one: as fours they would wait for what was just stored alone.
  const double* s = &state_[at(first, kX)];
  const FourModes now{Lanes{s[0], s[4], s[8], s[12]}, Lanes{s[1], s[5], s[9], s[13]}, Lanes{}, Lanes{}};
  const Lanes omega = fourOf(given_omega_, first) * lanesAt(ratio_.data() + first);
  ModeHistory::Place place;
  if (ahead < 0.0 && history_.find(-ahead, place)) return look(history_, place, first, omega, now, then);
  const Lanes force = fourOf(force_, first), zeta = lanesAt(damping_.data() + first);
  const Lanes rock = fourOf(contact_, first) * (follows_contact_ ? state_[kContact] : 0.0);
  const Lanes acceleration = force + rock - 2.0 * zeta * omega * now.v - omega * omega * now.x;
  then.force_rate = fourOf(force_rate_, first);
  then.x = now.x + ahead * now.v, then.v = now.v + ahead * acceleration;
  then.force = force + ahead * then.force_rate;
}

HAMMER_LOADS_AVX2 void ModeIdentifier::findMotionsAvx2(int first, double ahead, FourModes& then) const noexcept {
  findMotions(first, ahead, then);
}

ModeState ModeIdentifier::motionAt(int mode, double ahead) const noexcept {
  FourModes then;
  const int first = mode / kLane * kLane;
  if (kHasAvx2) {
    findMotionsAvx2(first, ahead - crankLead(), then);
  } else {
    findMotions(first, ahead - crankLead(), then);
  }
  return {then.x[mode - first], then.v[mode - first]};
}

/// Of four modes, for readings of one instant.
struct ModeIdentifier::Seen {
  FourModes then;
  Lanes acceleration, stiff, damped, rock;
  Lanes cosine, sine;  ///< of what was then: how displacement and velocity of now show in it
};

HAMMER_LOADS_INLINE void ModeIdentifier::see(int first, double ahead, Seen& seen) const noexcept {
  findMotions(first, ahead, seen.then);
  const Lanes omega = fourOf(given_omega_, first) * lanesAt(ratio_.data() + first);
  seen.stiff = omega * omega, seen.damped = 2.0 * lanesAt(damping_.data() + first) * omega;
  seen.rock = fourOf(contact_, first) * (follows_contact_ ? 1.0 : 0.0);
  seen.acceleration =
      seen.then.force + seen.rock * state_[kContact] - seen.damped * seen.then.v - seen.stiff * seen.then.x;
  const Lanes turned = seen.stiff * square(ahead);
  seen.sine = ahead * (1.0 - turned * (1.0 / 6.0)), seen.cosine = 1.0 - 0.5 * turned;
}

/// What is predicted of the reading.
HAMMER_LOADS_INLINE double ModeIdentifier::findRow(const VibrationReading& reading, const SeenModes& modes,
                                                   State& row) const noexcept {
  for (int i = 0; i < kModes; i += kLane) store(Lanes{}, &row[i]);
  Lanes predicted{}, late{}, by_contact{};
  for (int first = 0; first < count_; first += kLane) {
    Lanes by_x{}, by_v{}, by_a{}, by_oil{};  // per modal displacement, velocity, acceleration
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const int joint = modes_.joint[k];
      if (reading.of_oil) {
        by_oil += reading.oil[joint] * fourOf(inertia_[k], first);
        continue;
      }
      const Lanes shape = fourOf(shape_[k], first);
      by_x += reading.displacement[joint] * shape;
      by_v += reading.velocity[joint] * shape;
      by_a += reading.acceleration[joint] * shape;
    }
    const Seen& seen = modes[static_cast<std::size_t>(first / kLane)];
    const Lanes held = by_oil - by_a, damped = seen.damped * seen.then.v, stiff = seen.stiff * seen.then.x;
    const Lanes of_x = by_x + held * seen.stiff, of_v = by_v + held * seen.damped;
    predicted += by_x * seen.then.x + by_v * seen.then.v + by_a * seen.acceleration + by_oil * (stiff + damped);
    late += of_x * seen.then.v + of_v * seen.acceleration + by_a * seen.then.force_rate;
    by_contact += by_a * seen.rock;
    Lanes x = seen.cosine * of_x - seen.stiff * seen.sine * of_v, v = seen.cosine * of_v + seen.sine * of_x;
    Lanes frequency = held * (2.0 * stiff + damped), damping = held * damped;
    transpose(x, v, frequency, damping);
    double* to = &row[at(first, kX)];
    store(x, to), store(v, to + kLane), store(frequency, to + 2 * kLane), store(damping, to + 3 * kLane);
  }
  const int offset = offsetAt(reading.channel);
  row[offset] = 1.0;
  row[kContact] = sumOf(by_contact);
  if (reading.clock != Clock::kCrank) row[delayAt(reading.clock)] = -sumOf(late);
  return state_[offset] + sumOf(predicted);
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

HAMMER_LOADS_INLINE bool ModeIdentifier::counts(const VibrationReading& reading) noexcept {
  return reading.channel >= 0 && reading.channel < kMaxChannels && std::isfinite(reading.value);
}

/// One reading after the other: its P row^T is that of the covariance as it stands, less what those before it have
/// shown.
void ModeIdentifier::take(const VibrationReading* readings, std::size_t count, Shown& shown) noexcept {
  if (kHasAvx2) return takeAvx2(readings, count, shown);
  takeAny(readings, count, shown);
}

HAMMER_LOADS_AVX2 void ModeIdentifier::takeAvx2(const VibrationReading* readings, std::size_t count,
                                                Shown& shown) noexcept {
  takeAny(readings, count, shown);
}

HAMMER_LOADS_INLINE void ModeIdentifier::takeAny(const VibrationReading* readings, std::size_t count,
                                                 Shown& shown) noexcept {
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
      const double seen = times(shown.column[k], rows.offset[r], rows.row[r]);
      add(-seen / shown.S[k], shown.column[k], gain_S);
      if (k >= first) difference -= shown.moved[k] * seen;
    }
    const double S = weigh(*rows.reading[r], times(gain_S, rows.offset[r], rows.row[r]), difference);
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

HAMMER_LOADS_INLINE void ModeIdentifier::findRows(const VibrationReading* readings, std::size_t count,
                                                  Rows& rows) const noexcept {
  SeenModes seen;
  for (int first = 0; first < count_; first += kLane)
    see(first, readings->ahead - delayByCrank(readings->clock), seen[static_cast<std::size_t>(first / kLane)]);
  for (const VibrationReading* reading = readings; reading < readings + count; ++reading) {
    if (!counts(*reading)) continue;
    rows.difference[rows.count] = reading->value - findRow(*reading, seen, rows.row[rows.count]);
    rows.offset[rows.count] = offsetAt(reading->channel);
    rows.reading[rows.count++] = reading;
  }
}

/// S of a reading, by the variance of what is predicted; 0: it does not count.
HAMMER_LOADS_INLINE double ModeIdentifier::weigh(const VibrationReading& reading, double predicted,
                                                 double difference) noexcept {
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
HAMMER_LOADS_INLINE ModeIdentifier::Kept ModeIdentifier::keptStates() const noexcept {
  Kept kept;
  if (!learns_) return kept;
  for (int k = 0; keeps_oil_ && k < count_; ++k) kept.add(at(k, kFrequency)), kept.add(at(k, kDamping));
  if (keeps_oil_) kept.add(delayAt(Clock::kImu));
  if (keeps_oil_ || !delayShows(Clock::kPressures)) kept.add(delayAt(Clock::kPressures));
  return kept;
}

/// What a reading has shown of these. The rest counts it as with them not known better (Schmidt-Kalman filter).
HAMMER_LOADS_INLINE void ModeIdentifier::takeBack(const Kept& kept, double moved, double S, const State& gain_S,
                                                  Shown& shown) noexcept {
  State& its_part = shown.add(-S, -moved);
  clear(its_part);
  for (int i : kept) {
    its_part[i] = gain_S[i];
    state_[i] -= moved * gain_S[i];
  }
}

/// Times a row, which has but one offset.
HAMMER_LOADS_INLINE double ModeIdentifier::times(const State& a, int offset, const State& row) const noexcept {
  Lanes sum{};
  for (int i = kModes; i < end(); i += kLane) sum += lanesAt(&a[i]) * lanesAt(&row[i]);
  double all = sumOf(sum) + a[offset];
  for (int i = kDelays; i <= kContact; ++i) all += a[i] * row[i];
  return all;
}

HAMMER_LOADS_INLINE void ModeIdentifier::add(double factor, const State& what, State& to) const noexcept {
  for (int i = begin(); i < end(); i += kLane) store(lanesAt(&to[i]) + factor * lanesAt(&what[i]), &to[i]);
}

HAMMER_LOADS_INLINE void ModeIdentifier::copy(const State& from, State& to) const noexcept {
  for (int i = begin(); i < end(); i += kLane) store(lanesAt(&from[i]), &to[i]);
}

HAMMER_LOADS_INLINE void ModeIdentifier::clear(State& state) const noexcept {
  for (int i = begin(); i < end(); i += kLane) store(Lanes{}, &state[i]);
}

}  // namespace hammer_loads
