// The sensors' time: forces and blows act on the modes at the IMU's stamps; the returned motion is that at the crank's
// stamps. Delays of stamps: start and end of their estimation, and their deviations.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kDelayWalk = 2e-5;  // random walk of a delay in a second [s]: clocks drift by some 20 ppm
// Prior: kDelayWalk
constexpr double kOilWithDelay = 0.1;      // deviation of log stiffness, beside what was known without a delay
constexpr double kWrongPart = 0.05;        // relative error of an identified delay
constexpr double kWrongByPressures = 0.3;  // by them alone
constexpr double kLeadDeviations =
    0.6;  // number of deviations of an expected lead; the deviations are large, see ConstantErrors
constexpr double kWrongLead = 0.3;  // relative error of the crank's lead, which may be a sensor's
// Prior: kOilWithDelay, kWrongPart, kWrongByPressures, kWrongLead

constexpr double kLeastStep = 0.25;  // part of the crank's step, just after the delay was identified
// Numerical: kLeastStep

/// Value nearer to 0 of two of equal sign; else 0.
double lesserOf(double a, double b) noexcept {
  return a * b > 0.0 ? std::copysign(std::min(std::abs(a), std::abs(b)), a) : 0.0;
}

}  // namespace

/// Takes forces from the queue until the IMU's delay remains in it; the delay changes little in a step. With early
/// stamps the sensors' time waits for the crank.
void ModeIdentifier::applyForces(double step) noexcept {
  const double early = std::max(0.0, -imuDelay());
  const double own = std::max(kLeastStep * step, step + waiting_ - early);
  waiting_ += step - own;
  double due = held_.length() - std::max(0.0, imuDelay());
  if (!(due > 0.0)) return advanceModes({own, force_, force_, force_, false, {}});
  const double stretch = own / due;
  while (!held_.empty()) {
    HeldForces::Piece piece = held_.take(due);
    if (!(piece.duration > 0.0)) break;
    due -= piece.duration;
    piece.duration *= stretch;
    if (struck_) addBlowToDelay(piece.from - force_);
    advanceModes(piece);
    if (piece.strikes) applyBlow(piece.jump);
  }
}

void ModeIdentifier::strike(const JointVector& impulse) noexcept {
  if (!moving_known_) return;
  ModeVector jump = ModeVector::Zero();
  jump.head(count_) = modalForce(modes_, impulse);
  if (!held_.empty()) return held_.strike(jump);
  applyBlow(jump);
}

void ModeIdentifier::applyBlow(const ModeVector& jump) noexcept {
  for (int k = 0; k < count_; ++k) {
    state_[at(k, kV)] += jump[k];
    history_.strike(k, jump[k]);
    covariance_(at(k, kV), at(k, kV)) += square(kForcePart * jump[k]);
  }
  struck_ = jump;
}

/// State at the crank's stamp.
ModeState ModeIdentifier::motion(int mode) const noexcept {
  return momentAt(mode, imuDelay() + waiting_ - crankLead()).state;
}

/// State in the sensors' time.
ModeHistory::Moment ModeIdentifier::momentAt(int mode, double ahead) const noexcept {
  ModeHistory::Place place;
  if (ahead < 0.0 && history_.find(-ahead, place)) return history_.at(place, mode, modeAt(mode).omega, stateOf(mode));
  return momentAhead(mode, ahead);
}

/// State carried through the queued forces by a Taylor series of third order, with an error of 1e-4 for 0.5 ms of the
/// fastest mode. Beyond the queue, and before the history, the last force is kept.
ModeHistory::Moment ModeIdentifier::momentAhead(int mode, double ahead) const noexcept {
  const Mode m = modeAt(mode);
  const double external = forceOfSeals(way_)[mode] + rockOn(mode) * state_[kContact], damped = 2.0 * m.zeta * m.omega;
  ModeHistory::Moment moment{stateOf(mode), force_[mode], force_rate_[mode]};
  const auto move = [&](double h) {
    ModeState& now = moment.state;
    const double a = acceleration(m, now, moment.force + external);
    const double jerk = moment.force_rate - damped * a - square(m.omega) * now.v;
    now.x += h * (now.v + 0.5 * h * (a + h / 3.0 * jerk)), now.v += h * (a + 0.5 * h * jerk);
    moment.force += h * moment.force_rate;
  };
  double left = ahead;
  for (std::size_t i = 0; i < held_.size() && left > 0.0; ++i) {
    const HeldForces::Piece& piece = held_[i];
    moment.force = piece.from[mode], moment.force_rate = (piece.to[mode] - piece.from[mode]) / piece.duration;
    move(std::min(left, piece.duration));
    if (left >= piece.duration) moment.state.v += piece.jump[mode];
    left = std::max(0.0, left - piece.duration);
  }
  move(left);
  return moment;
}

/// Starts the estimation of a delay once the frequencies have been known for a while; earlier, a delay would compensate
/// any other error. The frequencies found without the delay may be wrong.
void ModeIdentifier::followDelay(Clock clock) noexcept {
  if (!learns_ || isDelayFollowed(clock) || known_for_ < look_back::kTurn || !delayShows(clock)) return;
  covariance_(delayAt(clock), delayAt(clock)) = square(kDelayDeviation);
  if (clock == Clock::kPressures) return unlearn(1.0);
  innovation_ratio_ = 1.0;  // the delay may explain the earlier misfit
  unlearns_for_ = kProven;
}

/// Reduces the information on oil and damping that was gained without a delay.
void ModeIdentifier::unlearn(double part) noexcept {
  for (int k = 0; k < count_; ++k) {
    covariance_(at(k, kOil), at(k, kOil)) += part * square(kOilWithDelay);
    covariance_(at(k, kDamping), at(k, kDamping)) += part * square(kDampingDeviation);
  }
}

void ModeIdentifier::advanceDelays(double step) noexcept {
  if (unlearns_for_ > 0.0) unlearn(step / kProven), unlearns_for_ -= step;
  bool follows = false;
  for (int i : {kDelays, kDelays + 1}) {
    double& variance = covariance_(i, i);
    if (variance > 0.0) variance += misfit() * square(kDelayWalk) * step, follows = true;
  }
  if (!follows) {
    known_for_ = identified() ? known_for_ + step : 0.0;
    return;
  }
  // An identified delay imitates the force of a rock that bears on the hull unnoticed.
  lost_for_ = identified() ? 0.0 : lost_for_ + step;
  if (lost_for_ > kProven) forgetOil();
}

bool ModeIdentifier::imuSpeaks() const noexcept { return imu_age_ < look_back::kHalfTurn; }

/// Pressures alone do not show their delay on rock, nor until it is clear that there is none, as any missing force may
/// be the rock's.
bool ModeIdentifier::delayShows(Clock clock) const noexcept {
  return clock == Clock::kImu || free_for_ > kProven || imuSpeaks();
}

/// Delay relative to the crank's stamps.
double ModeIdentifier::delayVariance(Clock clock) const noexcept {
  const auto& P = covariance_.block<2, 2>(kDelays, kDelays);
  return clock == Clock::kImu ? P(0, 0) : P.sum();
}

double ModeIdentifier::delay(Clock clock) const noexcept {
  return isDelayFollowed(clock) ? delayByCrank(clock) - crankLead() : 0.0;
}

/// Common delay of all clocks with an estimated delay, weighted by its agreement with the expected lead: the more the
/// rest exceeds the expectation, the lower its weight. A sensor without delay shows no lead.
double ModeIdentifier::findCrankLead() const noexcept {
  double common = 0.0;
  bool first = true;
  for (Clock clock : {Clock::kImu, Clock::kPressures}) {
    if (!isDelayFollowed(clock)) continue;
    common = first ? delayByCrank(clock) : lesserOf(common, delayByCrank(clock));
    first = false;
  }
  const double deviation = kLeadDeviations * expected_lead_.deviation, rest = common - expected_lead_.mean;
  return lesserOf(common, expected_lead_.mean + (std::abs(rest) <= deviation ? rest : square(deviation) / rest));
}

ModeIdentifier::Lag ModeIdentifier::lagOf(Clock clock, int mode) const noexcept {
  if (clock != Clock::kPressures) return {clock == Clock::kCrank ? -imuDelay() : 0.0, 1.0};
  const double late = pressureLag();
  if (!imuSpeaks() || !(late > 0.0)) return {late, 1.0};
  const double deviation = std::sqrt(covariance_(delayAt(clock), delayAt(clock)));
  if (!(late > gate::kVeryRare * deviation)) return {late, 1.0};  // only a hose causes so large a delay
  const double omega = modeAt(mode).omega, turned = omega * late;
  return {std::atan(turned) / omega, 1.0 / std::sqrt(1.0 + square(turned))};
}

/// First-order lag with a linear input over the step. A shorter lag is described well enough by a delay of each mode.
void ModeIdentifier::followHose(double step, const States& now, const States& next) noexcept {
  const double late = pressureLag();
  if (!(late > step && lagOf(Clock::kPressures, 0).left < 1.0)) return behind_hose_.reset();
  if (!behind_hose_) {
    BehindHose begins;
    for (int k = 0; k < count_; ++k) begins.torque[k] = oilTorqueRead(k, 0.0);
    behind_hose_ = begins;
  }
  for (int k = 0; k < count_; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    behind_hose_->follow(k, step, late, torqueOf(k, now[mode]), torqueOf(k, next[mode]));
  }
}

/// Corrects the torque behind the hose by the correction of the motion, taken as a free oscillation over the hose's
/// time constant.
void ModeIdentifier::correctHose(const State& by) noexcept {
  if (!behind_hose_) return;
  const double late = pressureLag();
  for (int k = 0; k < count_; ++k) {
    const double omega = modeAt(k).omega, x = by[at(k, kX)], v = by[at(k, kV)];
    behind_hose_->torque[k] += torqueOf(k, {x - late * v, v + square(omega) * late * x}) / (1.0 + square(omega * late));
  }
}

double ModeIdentifier::delayDeviation(Clock clock) const noexcept {
  if (clock == Clock::kCrank) return 0.0;
  const double wrong = imuSpeaks() ? kWrongPart : kWrongByPressures;
  const double lead = crankLead();
  double largest = 0.0;  // the delays of both clocks cannot be separated
  for (Clock each : {Clock::kImu, Clock::kPressures})
    if (isDelayFollowed(each)) largest = std::max(largest, std::abs(delayByCrank(each) - lead));
  return std::sqrt(delayVariance(clock) + square(wrong * largest) + square(kWrongLead * lead));
}

/// Variance of the prediction by a delay that is not estimated yet. It is treated as noise, so that the delay does not
/// bias the oil. Without an IMU, pressures hardly show their delay, and it may never be estimated.
double ModeIdentifier::byDelay(Clock clock, const State& row) const noexcept {
  if (!learns_ || clock == Clock::kCrank || !imuSpeaks() || isDelayFollowed(clock)) return 0.0;
  return square(kDelayDeviation * row[delayAt(clock)]);
}

/// Standard deviation of the instant of an IMU reading [s].
double ModeIdentifier::imuStampDeviation() const noexcept {
  const double unknown = learns_ ? square(kDelayDeviation) : 0.0;
  return std::sqrt((isDelayFollowed(Clock::kImu) ? delayVariance(Clock::kImu) : unknown) +
                   jitterVariance(Clock::kImu, 0));
}

/// Variance of the stamps' jitter [s2], as a channel shows it; for the IMU, whose channels have one clock, the largest
/// of its channels.
double ModeIdentifier::jitterVariance(Clock clock, int own) const noexcept {
  if (clock != Clock::kImu) return jitter_[static_cast<std::size_t>(own)].variance();
  double variance = 0.0;
  for (std::size_t i = 0; i < jitter_.size(); ++i)
    if (clock_[i] == clock) variance = std::max(variance, jitter_[i].variance());
  return variance;
}

}  // namespace hammer_loads
