// Readings: what a sensor shows of the modes, and what that says of their oil.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
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

void ModeIdentifier::useChannel(int channel, const VibrationReading& reading) noexcept {
  const auto i = static_cast<std::size_t>(channel);
  const double first = square(reading.offset_deviation), walk = square(reading.offset_walk);
  if (slot_[i] < 0) {
    ++channels_;
    slot_[i] = begin();
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

ModeThen ModeIdentifier::motionByCrank(int mode, double ahead) const noexcept {
  const ModeState now = stateOf(mode);
  ModeHistory::Place then;
  if (ahead < 0.0 && history_.find(-ahead, then)) return history_.at(mode, then, modeAt(mode).omega, now);
  return {{now.x + ahead * now.v, now.v + ahead * accelerationNow(mode)},
          force_[mode] + ahead * force_rate_[mode],
          force_rate_[mode]};
}

ModeIdentifier::State ModeIdentifier::rowOf(int channel, const VibrationReading& reading,
                                            double& predicted) const noexcept {
  State row = State::Zero();
  row[offsetAt(channel)] = 1.0;
  predicted = state_[offsetAt(channel)];
  const double ahead = reading.ahead - delayByCrank(reading.clock);
  for (int k = 0; k < count_; ++k) {
    double by_x = 0.0, by_v = 0.0, by_a = 0.0, by_oil = 0.0;  // per modal displacement, velocity, acceleration
    for (int i = 0; i < count_; ++i) {
      const int joint = modes_.joint[static_cast<std::size_t>(i)];
      by_x += reading.displacement[joint] * modes_.shape(i, k);
      by_v += reading.velocity[joint] * modes_.shape(i, k);
      by_a += reading.acceleration[joint] * modes_.shape(i, k);
      by_oil += reading.oil[joint] * modes_.inertia(joint, k);
    }
    const Mode m = modeAt(k);
    const ModeThen then = motionByCrank(k, ahead);
    const ModeState s = then.motion;
    const double a = acceleration(m, s, then.force + rockOn(k) * state_[kContact]);
    const double stiff = m.omega * m.omega, damped = 2.0 * m.zeta * m.omega, held = by_oil - by_a;
    const double of_x = by_x + held * stiff, of_v = by_v + held * damped;
    const double rate = of_x * s.v + of_v * a + by_a * then.force_rate;
    predicted += by_x * s.x + by_v * s.v + by_a * a + by_oil * (stiff * s.x + damped * s.v);
    if (reading.clock != Clock::kCrank) row[delayAt(reading.clock)] -= rate;
    row[kContact] += by_a * rockOn(k);
    const double turned = square(m.omega * ahead), sine = ahead * (1.0 - turned / 6.0), cosine = 1.0 - turned / 2.0;
    row[at(k, kX)] = cosine * of_x - stiff * sine * of_v;
    row[at(k, kV)] = cosine * of_v + sine * of_x;
    row[at(k, kFrequency)] = held * (2.0 * stiff * s.x + damped * s.v);
    row[at(k, kDamping)] = held * damped * s.v;
  }
  return row;
}

void ModeIdentifier::observe(int channel, const VibrationReading& reading) noexcept {
  if (!moving_known_ || channel < 0 || channel >= kMaxChannels || !std::isfinite(reading.value)) return;
  useChannel(channel, reading);
  if (reading.clock == Clock::kImu) imu_age_ = 0.0;
  if (reading.clock != Clock::kCrank) followDelay(reading.clock);
  double predicted = 0.0;
  const State row = rowOf(channel, reading, predicted);
  const int first = begin(), n = states(), own = n - channels_;  // no row has another channel's offset
  State gain_S;
  gain_S.head(n) = column(offsetAt(channel));
  gain_S.head(n).noalias() += covariance_.block(first, kDelays, n, own) * row.segment(kDelays, own);
  double S = row.segment(first, n).dot(gain_S.head(n)) + square(reading.noise) + square(reading.neglected);
  const double difference = reading.value - predicted;
  if (!(S > 0.0) || !std::isfinite(S) || !std::isfinite(difference)) return;
  if (!reading.acceleration.isZero(0.0)) {
    explains_ = explains_ ? surprise_ < kSurprised || (learns_ && !identified()) : surprise_ < kCalm;
    surprise_ +=
        kSurpriseShare * (std::min(kWorstSurprise, square(difference) / (S - square(reading.neglected))) - surprise_);
  }
  if (!reading.oil.isZero(0.0))
    oil_surprise_ += kOilSurpriseShare * (std::min(kWorstSurprise, square(difference) / S) - oil_surprise_);
  S *= std::max(1.0, std::abs(difference) / (kFarOff * std::sqrt(S)));
  state_.segment(first, n) += gain_S.head(n) * (difference / S);
  for (int i = 0; i < n; ++i) {
    double* column = &covariance_(first, first + i);
    const double part = gain_S[i] / S;
    for (int j = 0; j < n; ++j) column[j] -= part * gain_S[j];
  }
  if (learns_) takeBack(kept(), gain_S, S, difference);
  if (reading.clock != Clock::kCrank) takeAsLate(reading.clock);
  if (learns_ && !explains_) forgetOil();
  if (!state_.segment(first, n).allFinite()) return startAnew();
  if (learns_) useOil();
}

/// States that readings are not to change.
ModeIdentifier::Kept ModeIdentifier::kept() const noexcept {
  Kept kept;
  for (int k = 0; keeps_oil_ && k < count_; ++k) kept.add(at(k, kFrequency)), kept.add(at(k, kDamping));
  if (keeps_oil_) kept.add(delayAt(Clock::kImu));
  if (keeps_oil_ || !delayShows(Clock::kPressures)) kept.add(delayAt(Clock::kPressures));
  return kept;
}

/// What the last reading has shown of these. The rest counts it as with them not known better (Schmidt-Kalman filter).
void ModeIdentifier::takeBack(const Kept& kept, const State& gain_S, double S, double difference) noexcept {
  for (int i : kept) {
    const double gain = gain_S[i - begin()] / S;
    state_[i] -= gain * difference;
    for (int j : kept) covariance_(i, j) += gain * gain_S[j - begin()];
  }
}

void ModeIdentifier::forgetOil() noexcept {
  forget(kDelays, 0.0), forget(kDelays + 1, 0.0);
  least_delay_ = {};
  known_for_ = lost_for_ = 0.0;
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
  constexpr double kNear = 1e-4;
  // exp() of a small number: exact to rounding, at a tenth of the time.
  const auto grow = [](double x) { return std::abs(x) < kNear ? 1.0 + x * (1.0 + x * (0.5 + x / 6.0)) : std::exp(x); };
  for (int k = 0; k < count_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    double &frequency = state_[at(k, kFrequency)], &damping = state_[at(k, kDamping)];
    frequency = std::clamp(frequency, -kMostRatio, kMostRatio);
    damping = std::clamp(damping, least_damping_, most_damping_);
    ratio_[i] *= grow(frequency - used_frequency_[i]), used_frequency_[i] = frequency;
    damping_[i] *= grow(damping - used_damping_[i]), used_damping_[i] = damping;
  }
  for (int i : {kDelays, kDelays + 1}) state_[i] = std::clamp(state_[i], -kMostEarly, kMostLate);
}

}  // namespace hammer_loads
