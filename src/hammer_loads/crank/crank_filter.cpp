#include "hammer_loads/crank/crank_filter.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kWiden = 25.0;            // innovation^2 over its variance from which on the model does not explain it
constexpr double kDoubtfulAngle = 0.3;     // [rad] predicted deviation from which on the prediction is worth nothing
constexpr double kJump = 0.5;              // [rad] innovation that no working machine makes between two samples
constexpr double kKick = 0.35;             // of the speed: what no torque changes between two samples
constexpr double kLeastInertia = 0.1;      // of the first guess: no drawing is further off
constexpr double kMostInertia = 1000.0;    // times the first guess: a crank held at constant speed looks that heavy
constexpr double kLearnSpeed = 5.0;        // [rad/s]: a slower crank is moved by friction and stopped by the tool
constexpr double kRelearn = 0.05;          // relative deviation of the inertia after what it cannot explain
constexpr double kMostTorque = 3.0;        // times its first deviation: more is what a bad sample left behind
constexpr double kSoundSpeeds = 2.0;       // times the largest plausible speed: more is a diverged filter
constexpr double kSpeedNoiseGain = 0.005;  // per sample: the noise of measured speeds is learned within some 200
constexpr double kNearCounts = 4.0;        // counts from the blow within which the encoder decides its side
constexpr double kLeastSpeedNoise = 0.3;   // of the first guess
constexpr double kToolZone = 0.06;         // [rad] around the dead centre where the tool may be met: 3.4 deg
constexpr double kToolSteps = 1.5;         // steps around it likewise
constexpr double kToolDeviation = 0.5;     // of the crank's speed: what a tool met there may take
constexpr double kToolSeen = 16.0;         // innovation^2 over its variance that shows it
constexpr double kCertain = 3.0;           // deviations of the stamp within which the encoder's edge decides nothing
constexpr double kSurpriseLength = 50.0;   // samples over which innovations beyond 5 deviations are counted
constexpr double kManySurprises = 2.5;     // of them: more than a supply's jolts
constexpr double kSlip = 3e-3;             // [s]: stamps that are off by so much, again and again alike
constexpr double kDecided = 12.0;          // logarithm of odds at which the less likely belief is given up
constexpr double kChange = 9.0;            // likewise at which the other one becomes the estimate
constexpr double kMostFit = 8.0;           // likewise that one measurement may add: it may be an outlier
constexpr double kUnexplained = 3.0;       // mean innovation^2 over its variance
constexpr double kUnlearnEvery = 3.0;      // [s]
constexpr double kForgetRestarts = 2.0;    // [s]
constexpr double kForgetDoubts = 30.0;     // [s]

double square(double x) noexcept { return x * x; }

/// But for a constant.
template <typename Innovation>
double logLikelihood(const Innovation& i) noexcept {
  return -0.5 * (i.ratio() + std::log(i.total));
}

}  // namespace

CrankFilter::CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings)
    : model_(model),
      step_model_(model),
      settings_(settings),
      first_guess_(drive_inertia),
      encoder_(settings.angle_resolution, settings.sensor),
      timing_(settings.timing_noise),
      blows_({settings.blow_factor, settings.blow_deviation}),
      speed_variance_(square(settings.speed_noise)) {
  now_.state.drive_inertia = drive_inertia;
  now_.least_inertia = kLeastInertia * drive_inertia;
  now_.most_inertia = kMostInertia * drive_inertia;
  now_.factor = settings.blow_factor;
  now_.covariance(Belief::kInertia, Belief::kInertia) = square(settings.initial_inertia_deviation);
}

double CrankFilter::mostSpeed() const noexcept { return kSoundSpeeds * settings_.max_speed; }

/// Angle and speed of the crank from those of its sensor.
CrankSample CrankFilter::ofCrank(const CrankSample& reading) noexcept {
  CrankSample sample{encoder_.angle(reading.angle), reading.speed};
  if (sample.speed) sample.speed = encoder_.speed(sample.angle, *reading.speed);
  return sample;
}

void CrankFilter::start(const CrankSample& reading) noexcept {
  const CrankSample sample = ofCrank(reading);
  now_.state.position = {0, CrankAngle::fromAngle(sample.angle)};
  now_.state.speed = 0.0;
  now_.state.torque = 0.0;
  anchor(now_.state.position.angle.offset, sample);
}

/// Takes angle and speed from the sample alone; the torque is in doubt, the inertia stays as identified. The whole
/// turns are those nearest to now_.
void CrankFilter::anchor(double measured, const CrankSample& sample) noexcept {
  ShaftState& s = now_.state;
  const double inertia_variance = now_.covariance(Belief::kInertia, Belief::kInertia);
  s.position.turn(CrankAngle::wrapToPi(measured - s.position.angle.offset));
  s.speed = sample.speed.value_or(s.speed);
  const double most_torque = kMostTorque * settings_.initial_torque_deviation;
  s.torque = std::clamp(s.torque, -most_torque, most_torque);
  has_speed_ = sample.speed.has_value();
  outlier_ = 0.0;
  unexplained_ = 0;
  load_ = model_(s.position.angle);
  now_hull_ = model_.hullMotion();
  now_.tool_met = false;
  mirrored_ = false;
  rival_.reset();
  now_.factor = settings_.blow_factor;
  ShaftMatrix& p = now_.covariance;
  p.setZero();
  p(Belief::kAngle, Belief::kAngle) = angleVariance();
  p(Belief::kSpeed, Belief::kSpeed) = has_speed_ ? speed_variance_ : square(settings_.max_speed);
  p(Belief::kTorque, Belief::kTorque) = square(settings_.initial_torque_deviation);
  // NaN-proof by min: never above the first guess
  p(Belief::kInertia, Belief::kInertia) = std::min(square(settings_.initial_inertia_deviation), inertia_variance);
  p(Belief::kFactor, Belief::kFactor) = square(settings_.blow_deviation);
  now_.by_error.setZero();
  now_.by_error.row(Belief::kAngle) = SensorErrors::ofAngle(s.position.angle.offset);
}

int CrankFilter::predict(double dt, bool contact, CrankBelief& belief) const noexcept {
  const CrankWalks walks{settings_.torque_walk, settings_.speed_walk, settings_.inertia_walk};
  return belief.predict(step_model_, walks, blows_.prior(), contact, mostSpeed(), dt);
}

/// Of a measured angle about the angle at its stamp.
double CrankFilter::angleVariance() const noexcept {
  return encoder_.variance() + square(settings_.angle_noise) + square(now_.state.speed) * timing_.variance();
}

CrankFilter::Innovation CrankFilter::angleInnovation(double measured) const noexcept {
  const double variance = angleVariance();
  return {CrankAngle::wrapToPi(measured - now_.state.position.angle.offset),
          now_.covariance(Belief::kAngle, Belief::kAngle) + variance, variance,
          SensorErrors::ofAngle(now_.state.position.angle.offset)};
}

/// Of a measured speed about the speed at its stamp.
CrankFilter::Innovation CrankFilter::speedInnovation(double measured) const noexcept {
  const double explained =
      now_.covariance(Belief::kSpeed, Belief::kSpeed) +
      (timing_.variance() > 0.0
           ? square(acceleration(model_(now_.state.position.angle), now_.state)) * timing_.variance()
           : 0.0);
  return {measured - now_.state.speed, explained + speed_variance_, speed_variance_,
          SensorErrors::ofSpeed(now_.state.position.angle.offset, now_.state.speed)};
}

void CrankFilter::correctAngle(Innovation innovation) noexcept {
  const double squared = square(innovation.value), ratio = innovation.ratio();
  const int side = ratio > kWiden ? (innovation.value > 0.0 ? 1 : -1) : 0;
  if (side != 0) unexplained_ = side * unexplained_ < 0 ? side : unexplained_ + side;
  surprises_ += (side != 0 ? 1.0 : 0.0) - surprises_ / kSurpriseLength;
  if (side != 0 && ((std::abs(unexplained_) < 3 && surprises_ > kManySurprises) || isLost())) {
    innovation.variance = squared / kWiden;  // with many like it on both sides: the stamps
  } else if (side != 0) {
    ShaftMatrix& p = now_.covariance;
    const double factor = (0.25 * squared - innovation.variance) / p(Belief::kAngle, Belief::kAngle);
    if (factor > 1.0) p.topLeftCorner<3, 3>() *= factor, p.bottomLeftCorner<1, 3>() *= std::sqrt(factor);
    p.topRightCorner<3, 1>() = p.bottomLeftCorner<1, 3>().transpose();
    now_.forgetInertiaCoupling();
    // What does not fit may be the inertia itself: leave it room to be learned again.
    double& inertia = p(Belief::kInertia, Belief::kInertia);
    inertia = std::max(inertia, square(kRelearn));
  }
  if (surprises_ > kManySurprises) now_.forgetInertiaCoupling();  // they would teach it nonsense
  now_.correct(Belief::kAngle, innovation.value, innovation.variance, innovation.by_error);
}

/// A machine that is not explained for seconds may have been learned wrong while the stamps' jitter was not known.
void CrankFilter::doubtInertia(double dt) noexcept {
  unlearn_after_ -= dt;
  if (!(consistency_.growth() > kUnexplained) || unlearn_after_ > 0.0) return;
  unlearn_after_ = kUnlearnEvery;
  doubt_load_ += 1.0;
  now_.state.drive_inertia = first_guess_;
  now_.by_error.row(Belief::kInertia).setZero();
  now_.forgetInertiaCoupling();
  now_.covariance(Belief::kInertia, Belief::kInertia) = square(settings_.initial_inertia_deviation);
  now_.covariance(Belief::kTorque, Belief::kTorque) += square(settings_.initial_torque_deviation);
  consistency_ = {};
}

void CrankFilter::correctSpeed(double measured) noexcept {
  const Innovation innovation = speedInnovation(measured);
  fit_ += logLikelihood(innovation);
  const double squared = std::min(square(innovation.value), kWiden * innovation.total);
  if (square(innovation.value) <= squared)
    now_.correct(Belief::kSpeed, innovation.value, innovation.total - now_.covariance(Belief::kSpeed, Belief::kSpeed),
                 innovation.by_error);
  const double floor = square(kLeastSpeedNoise * settings_.speed_noise);
  speed_variance_ = std::max(speed_variance_ + kSpeedNoiseGain * (squared - innovation.total), floor);
}

/// The corrected angle may lie on the other side of the blow than the prediction. Forward: it passes the blow late.
/// Back over a blow that was predicted within this very step: there was none yet.
void CrankFilter::settleSide(const CrankBelief& last, double dt, double measured, bool struck) noexcept {
  CrankAngle& angle = now_.state.position.angle;
  if (mirrored_) {
    mirrored_ = now_.state.position.isMirrored();
    return;
  }
  if (!now_.state.position.isMirrored()) return;
  if (angle.side == Side::kBeforeBlow) {
    if (now_.state.speed > 0.0) {
      meetRival();
      return now_.passLate(step_model_, blows_.prior());
    }
    angle.side = Side::kAfterBlow;
    return;
  }
  if (struck) {
    rival_.reset();
    now_ = last;
    predict(dt, false, now_);
    const Innovation again = angleInnovation(measured);
    now_.correct(Belief::kAngle, again.value, again.variance, again.by_error);
    if (now_.state.position.isMirrored()) now_.state.position.angle.offset = 0.0;
    return;
  }
  const double doubt = kNearCounts * encoder_.resolution() + kCertain * std::sqrt(angleVariance());
  if (angle.offset > -doubt && now_.state.speed > -1.0) {
    angle.offset = 0.0;  // it stands or goes on, whatever a count or a stamp says
  } else {
    angle.side = Side::kBeforeBlow;
  }
}

/// A count says for certain on which side of the blow the crank is, if the count's edge is there and the stamp is
/// exact: the estimate may not pass the blow before the encoder does. Matters because the wrench jumps at the blow.
void CrankFilter::respectCount(double reading) noexcept {
  if (encoder_.isFiner() || settings_.angle_noise > 0.0 || mirrored_) return;
  const double count = encoder_.resolution(), edge_tolerance = 1e-6 * count;
  const double doubt = kCertain * std::abs(now_.state.speed) * timing_.deviation();
  const auto [low, high] = encoder_.edges(reading);
  CrankAngle& angle = now_.state.position.angle;
  if (std::abs(low) > kNearCounts * count || std::abs(angle.offset) > kNearCounts * count) return;
  if (low - doubt > -edge_tolerance && angle.side == Side::kBeforeBlow) {
    meetRival();
    angle.offset = 0.0;
    now_.passLate(step_model_, blows_.prior());
  }
  if (high + doubt < edge_tolerance && angle.side == Side::kAfterBlow) angle = {0.0, Side::kBeforeBlow};
}

/// now_ is about to pass the blow with contact; the rival goes on without.
void CrankFilter::meetRival() noexcept {
  if (mirrored_ || now_.tool_met) return;
  rival_ = now_;
  evidence_ = std::log(turns_without_ / turns_with_);
}

/// The rival takes the sample too. Its own outliers and jolts count against it.
void CrankFilter::followRival(double dt, double measured, const CrankSample& sample) noexcept {
  if (dt > 0.0) predict(dt, mirrored_, *rival_);
  std::swap(now_, *rival_);
  Innovation innovation = angleInnovation(measured);
  double fit = logLikelihood(innovation);
  innovation.variance = std::max(innovation.variance, square(innovation.value) / kWiden);
  now_.correct(Belief::kAngle, innovation.value, innovation.variance, innovation.by_error);
  if (sample.speed) {
    const Innovation speed = speedInnovation(*sample.speed);
    fit += logLikelihood(speed);
    if (speed.ratio() < kWiden)
      now_.correct(Belief::kSpeed, speed.value, speed.total - now_.covariance(1, 1), speed.by_error);
  }
  std::swap(now_, *rival_);
  evidence_ += std::clamp(fit - fit_, -kMostFit, kMostFit) / consistency_.growth();
  if (!rival_->isSound(mostSpeed())) rival_.reset();
}

/// Whether the estimate has changed to the other belief.
bool CrankFilter::chooseBelief() noexcept {
  const bool change = evidence_ > kChange;
  if (change) {
    std::swap(now_, *rival_);
    evidence_ = -evidence_;
    mirrored_ = !mirrored_;
  }
  if (evidence_ > -kDecided) return change;
  (mirrored_ ? turns_without_ : turns_with_) += 1.0;
  rival_.reset();
  return change;
}

/// Once a turn, half a turn after the blow: by then all samples that tell of it have come.
void CrankFilter::rememberBlow(const CrankBelief& last) noexcept {
  const CrankPosition &from = last.state.position, &to = now_.state.position;
  if (from.angle.side != Side::kAfterBlow || to.angle.side != Side::kBeforeBlow || to.blow != from.blow + 1) return;
  if (from.isMirrored() || to.isMirrored()) return;
  errors_.endTurn(consistency_.growth());
  blows_.add(now_.factor, now_.covariance(Belief::kFactor, Belief::kFactor), now_.by_error.row(Belief::kFactor));
}

/// A crank that is suddenly slower near the dead centre, or just after it than any blow makes it: the tool. True where
/// the belief has taken it up.
bool CrankFilter::meetsTool(double dt, const Innovation& angle, const CrankSample& sample) noexcept {
  const bool zone =
      std::abs(now_.state.position.angle.offset) < std::max(kToolZone, kToolSteps * now_.state.speed * dt);
  if (!zone || now_.state.speed < 1.0 || mirrored_) return false;
  const bool before = now_.state.position.angle.side == Side::kBeforeBlow;
  const bool by_angle = (angle.value < 0.0 || !before) && angle.ratio() > kToolSeen;
  bool by_speed = false;
  if (sample.speed) {
    const Innovation speed = speedInnovation(*sample.speed);
    by_speed = speed.ratio() > kToolSeen && speed.value * angle.value > 0.0 && (angle.value < 0.0 || !before);
  }
  if (!by_angle && !by_speed) return false;
  now_.meetTool(kToolDeviation, dt);
  now_.tool_met = before;
  return true;
}

/// Following it would throw speed and torque far off: 0.3 rad at 1 kHz gave a thousand times the peak force. A crank
/// at constant speed, which the model takes for a heavy one, stays below a kick of 0.35 from 100 Hz on; a slow one may
/// be stopped dead.
bool CrankFilter::isContradiction(double dt, const Innovation& innovation) const noexcept {
  const double most = std::max(kKick * std::abs(now_.state.speed), kLearnSpeed) * dt;
  return std::abs(innovation.value) > kJump || (std::abs(innovation.value) > most && innovation.ratio() > kWiden);
}

/// What lies before this sample is not known any more.
Tracking CrankFilter::begin(double measured, const CrankSample& sample) noexcept {
  restart_load_ += 1.0;
  anchor(measured, sample);
  return Tracking::kRestarted;
}

Tracking CrankFilter::update(double dt, const CrankSample& reading) noexcept {
  const CrankBelief last = now_;
  restart_load_ *= std::max(0.0, 1.0 - dt / kForgetRestarts);
  doubt_load_ *= std::max(0.0, 1.0 - dt / kForgetDoubts);
  step_model_.setHullMotion(blend(now_hull_, model_.hullMotion(), 0.5));
  const bool struck = predict(dt, true, now_) > 0;

  const CrankSample sample = ofCrank(reading);
  const double measured = CrankAngle::fromAngle(sample.angle).offset;
  Innovation innovation = angleInnovation(measured);
  const double deviation = std::sqrt(now_.covariance(Belief::kAngle, Belief::kAngle));
  if (!(deviation < kDoubtfulAngle) && has_speed_) {
    if (!now_.isSound(mostSpeed())) now_ = last;
    return begin(measured, sample);
  }
  const double ratio = innovation.ratio();
  if (has_speed_) {
    fit_ = logLikelihood(innovation);
    timing_.learn(innovation.value, innovation.total, now_.state.speed);
    if (meetsTool(dt, innovation, sample)) innovation = angleInnovation(measured);
    if (isContradiction(dt, innovation) && !isLost()) {
      const double most = kKick * std::abs(now_.state.speed) * dt + kKick * std::abs(outlier_);
      surprises_ += 1.0 - surprises_ / kSurpriseLength;
      const bool agrees = std::abs(CrankAngle::wrapToPi(innovation.value - outlier_)) < most;
      const bool confirmed = outlier_ != 0.0 && (agrees || surprises_ < kManySurprises);
      if (!confirmed) {
        now_ = last;
        outlier_ = innovation.value;
        return Tracking::kOutlier;
      }
      if (!agrees || std::abs(innovation.value) > kSlip * std::abs(now_.state.speed))
        return begin(measured, {sample.angle, std::nullopt});
      now_.forgetAngle(square(innovation.value));  // the sequence lost a sample: time is off, not the motion
      innovation = angleInnovation(measured);
    }
  }
  if (has_speed_ && std::abs(now_.state.speed) > kLearnSpeed) {
    consistency_.add(ratio);
    errors_.learn(innovation.value, innovation.total, innovation.by_error - now_.by_error.row(Belief::kAngle));
  }
  before_ = last;
  before_hull_ = now_hull_;
  step_ = dt;
  outlier_ = 0.0;
  if (struck) {
    std::swap(now_, before_);
    meetRival();
    std::swap(now_, before_);
  }
  const bool contested = rival_.has_value();
  if (std::abs(now_.state.speed) < kLearnSpeed) now_.forgetInertiaCoupling();
  correctAngle(innovation);
  settleSide(last, dt, measured, struck);
  respectCount(reading.angle);
  if (sample.speed) correctSpeed(*sample.speed);
  if (!mirrored_ && now_.state.position.isMirrored()) now_.state.position.angle.offset = 0.0;  // pushed by the speed
  if (contested && rival_) followRival(dt, measured, sample);
  const bool revised = rival_ && chooseBelief();
  if (!now_.isSound(mostSpeed())) {
    now_ = last;
    return begin(measured, sample);
  }
  rememberBlow(last);
  doubtInertia(dt);
  load_ = model_(now_.state.position.angle);
  now_hull_ = model_.hullMotion();
  const bool continued = has_speed_;
  has_speed_ = true;
  if (!continued) return Tracking::kRestarted;
  return revised ? Tracking::kRevised : Tracking::kContinued;
}

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  load_ = model_(now_.state.position.angle);
}

BlowFactor CrankFilter::blowFactor() const noexcept {
  const auto deviation = [&](Belief::Row row) { return std::sqrt(grown(now_)(row, row)); };
  return {now_.factor, deviation(Belief::kFactor), now_.state.drive_inertia, deviation(Belief::kInertia)};
}

bool CrankFilter::isPlausible() const noexcept {
  return std::abs(now_.state.torque) <= kMostTorque * settings_.initial_torque_deviation;
}

/// Faster or further than any crank gets within the last step.
bool CrankFilter::hasRunAway(const ShaftState& state) const noexcept {
  return !(std::abs(state.speed) < mostSpeed() &&
           std::abs(difference(state.position, before_.state.position)) <= mostSpeed() * step_ + 0.5 * kTwoPi);
}

/// The way forward from the earlier sample and the way back from the later one, each trusted near its own end. Between
/// samples that no machine makes either may run away; it is left out then.
CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  ShaftState state = before_.state, back = now_.state;
  ShaftLoad load = step_model_(state.position.angle), back_load = step_model_(back.position.angle);
  const bool contact = !before_.state.position.isMirrored() && !now_.state.position.isMirrored();
  const Passing passing{before_.tool_met ? 1.0 : now_.factor, contact};
  advance(step_model_, dt, passing, state, load);
  advance(step_model_, dt - step_, passing, back, back_load);
  const double part = dt / step_;
  if (hasRunAway(state)) {
    state = before_.state;
    state.position.turn(part * difference(now_.state.position, before_.state.position));
  }
  if (hasRunAway(back)) back = state;
  const double apart = part * difference(back.position, state.position);
  const Side forward_side = state.position.angle.side, back_side = back.position.angle.side;
  const bool smooth = forward_side == back_side || state.position.isMirrored() || back.position.isMirrored();
  if (smooth) {
    state.position.slide(apart);
  } else {
    state.position.turn(apart);
  }
  // Where the two ways pass the blow at different instants, each speed is taken over to the side that counts.
  const auto speedOn = [&](double speed, Side from) {
    if (from == state.position.angle.side || std::abs(state.position.angle.offset) > 1.0 || !(speed > 0.0))
      return speed;
    return state.position.angle.side == Side::kAfterBlow ? speed * passing.factor : speed / passing.factor;
  };
  const double forward_speed = speedOn(state.speed, forward_side), back_speed = speedOn(back.speed, back_side);
  state.speed = forward_speed + part * (back_speed - forward_speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  ShaftModel there = model_;
  there.setHullMotion(blend(before_hull_, now_hull_, dt / step_));
  return {state.position, state.speed, acceleration(there(state.position.angle), state)};
}

Eigen::Matrix3d CrankFilter::covarianceBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return motionCovariance(torque_part);
  CrankBelief belief = before_;
  predict(dt, true, belief);
  return hammer_loads::motionCovariance(model_, belief, grown(belief), torque_part);
}

/// By what the innovations show beyond the model, and by the sensor's errors, which are not corrected.
ShaftMatrix CrankFilter::grown(const CrankBelief& belief) const noexcept {
  const SensorErrors::Effect& effect = belief.by_error;
  return consistency_.growth() * belief.covariance + (effect * errors_.moment()) * effect.transpose();
}

}  // namespace hammer_loads
