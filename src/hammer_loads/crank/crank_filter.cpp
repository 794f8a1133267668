#include "hammer_loads/crank/crank_filter.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

enum Row : Eigen::Index { kAngle, kSpeed, kTorque, kInertia };

constexpr double kWiden = 25.0;         // innovation^2 over its variance from which on the model does not explain it
constexpr double kDoubtfulAngle = 0.3;  // [rad] predicted deviation from which on the prediction is worth nothing
constexpr double kJump = 0.5;           // [rad] innovation that no working machine makes between two samples
constexpr double kKick = 0.35;          // of the speed: what no torque changes between two samples
constexpr double kNoiseStep = 2e-3;     // [s] step over which the process noise is spread
constexpr double kMaxInertiaChange =
    0.3;                                 // of the logarithm by one sample: beyond it the linearisation is worth nothing
constexpr double kLeastInertia = 0.1;    // of the first guess: no drawing is further off
constexpr double kMostInertia = 1000.0;  // times the first guess: a crank held at constant speed looks that heavy
constexpr double kLearnSpeed = 5.0;      // [rad/s]: a slower crank is moved by friction and stopped by the tool
constexpr double kRelearn = 0.05;        // relative deviation of the inertia after what it cannot explain
constexpr double kMostTorque = 3.0;      // times its first deviation: more is what a bad sample left behind
constexpr double kSoundSpeeds = 2.0;     // times the largest plausible speed: more is a diverged filter
constexpr double kSpeedNoiseGain = 0.005;  // per sample: the noise of measured speeds is learned within some 200
constexpr double kNearCounts = 4.0;        // counts from the blow within which the encoder decides its side
constexpr double kLeastSpeedNoise = 0.3;   // of the first guess

double square(double x) noexcept { return x * x; }

}  // namespace

CrankFilter::CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings)
    : model_(model),
      step_model_(model),
      settings_(settings),
      first_guess_(drive_inertia),
      encoder_(settings.angle_resolution),
      speed_variance_(square(settings.speed_noise)) {
  now_.drive_inertia = drive_inertia;
  covariance_.setZero();
  covariance_(kInertia, kInertia) = square(settings.initial_inertia_deviation);
}

void CrankFilter::start(const CrankSample& sample) noexcept {
  now_.position = {0, CrankAngle::fromAngle(encoder_.angle(sample.angle))};
  now_.speed = 0.0;
  now_.torque = 0.0;
  anchor(now_.position.angle.offset, sample);
}

/// Takes angle and speed from the sample alone; the torque is in doubt, the inertia stays as identified. The whole
/// turns are those nearest to now_.
void CrankFilter::anchor(double measured, const CrankSample& sample) noexcept {
  const double inertia_variance = covariance_(kInertia, kInertia);  // NaN-proof by min: never above the first guess
  now_.position.turn(CrankAngle::wrapToPi(measured - now_.position.angle.offset));
  now_.speed = sample.speed.value_or(now_.speed);
  const double most_torque = kMostTorque * settings_.initial_torque_deviation;
  now_.torque = std::clamp(now_.torque, -most_torque, most_torque);
  has_speed_ = sample.speed.has_value();
  outlier_seen_ = false;
  load_ = model_(now_.position.angle);
  now_hull_ = model_.hullMotion();
  covariance_.setZero();
  covariance_(kAngle, kAngle) = encoder_.variance() + square(settings_.angle_noise);
  covariance_(kSpeed, kSpeed) = has_speed_ ? speed_variance_ : square(settings_.max_speed);
  covariance_(kTorque, kTorque) = square(settings_.initial_torque_deviation);
  covariance_(kInertia, kInertia) = std::min(square(settings_.initial_inertia_deviation), inertia_variance);
}

/// Advances state and covariance by dt with the process noise of the meantime.
void CrankFilter::predict(double dt, ShaftState& state, ShaftMatrix& covariance) const noexcept {
  ShaftLoad load = step_model_(state.position.angle);
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kNoiseStep)));
  const double h = dt / steps;
  const double torque = square(settings_.torque_walk) * h, speed = square(settings_.speed_walk) * h;
  for (int i = 0; i < steps && std::abs(state.speed) < kSoundSpeeds * settings_.max_speed; ++i) {
    const double b = 1.0 / (state.drive_inertia + load.inertia);
    const ShaftTransition f = advance(step_model_, h, state, load);
    const ShaftTransition moved = f * covariance;
    covariance.topLeftCorner<2, 2>().noalias() = moved * f.transpose();
    covariance.topRightCorner<2, 2>() = moved.rightCols<2>();
    covariance(kAngle, kAngle) += speed * h * h / 3.0;
    covariance(kSpeed, kSpeed) += speed + torque * square(b * h) / 3.0;
    covariance(kTorque, kTorque) += torque;
    covariance(kInertia, kInertia) += square(settings_.inertia_walk) * h;
    covariance(kAngle, kSpeed) += 0.5 * speed * h;
    covariance(kSpeed, kTorque) += 0.5 * torque * b * h;
    covariance(kSpeed, kAngle) = covariance(kAngle, kSpeed);
    covariance.bottomLeftCorner<2, 2>() = covariance.topRightCorner<2, 2>().transpose();
  }
}

/// Scalar measurement of one state variable.
void CrankFilter::correct(Eigen::Index row, double innovation, double variance) noexcept {
  const double total = covariance_(row, row) + variance;
  const Eigen::Vector4d column = covariance_.col(row);
  const Eigen::Vector4d change = column * (innovation / total);
  now_.position.turn(change[kAngle]);
  now_.speed += change[kSpeed];
  now_.torque += change[kTorque];
  const double inertia =
      now_.drive_inertia * std::exp(std::clamp(change[kInertia], -kMaxInertiaChange, kMaxInertiaChange));
  now_.drive_inertia = std::clamp(inertia, first_guess_ * kLeastInertia, first_guess_ * kMostInertia);
  covariance_.noalias() -= column * (column.transpose() / total);
}

/// The coming correction teaches nothing of the inertia.
void CrankFilter::forgetInertiaCoupling() noexcept {
  covariance_.topRightCorner<3, 1>().setZero();
  covariance_.bottomLeftCorner<1, 3>().setZero();
}

void CrankFilter::correctAngle(double innovation) noexcept {
  const double variance = encoder_.variance() + square(settings_.angle_noise);
  const double squared = innovation * innovation;
  if (squared > kWiden * (covariance_(kAngle, kAngle) + variance)) {
    const double factor = (0.25 * squared - variance) / covariance_(kAngle, kAngle);
    covariance_.topLeftCorner<3, 3>() *= factor;
    forgetInertiaCoupling();
    // What does not fit may be the inertia itself: leave it room to be learned again.
    covariance_(kInertia, kInertia) = std::max(covariance_(kInertia, kInertia), square(kRelearn));
  }
  correct(kAngle, innovation, variance);
}

void CrankFilter::correctSpeed(double measured) noexcept {
  const double innovation = measured - now_.speed;
  const double explained = covariance_(kSpeed, kSpeed);
  const double squared = std::min(innovation * innovation, kWiden * (explained + speed_variance_));
  if (innovation * innovation <= squared) correct(kSpeed, innovation, speed_variance_);
  const double floor = square(kLeastSpeedNoise * settings_.speed_noise);
  speed_variance_ = std::max(speed_variance_ + kSpeedNoiseGain * (squared - explained - speed_variance_), floor);
}

/// A count says for certain on which side of the blow the crank is, if the count's edge is there: the estimate may not
/// pass the blow before the encoder does. Matters because the wrench jumps at the blow.
void CrankFilter::respectCount(double reading) noexcept {
  if (encoder_.isFiner() || settings_.angle_noise > 0.0) return;
  const double count = settings_.angle_resolution, edge_tolerance = 1e-6 * count;
  const double low = CrankAngle::wrapToPi(reading), high = low + count;
  CrankAngle& angle = now_.position.angle;
  if (std::abs(low) > kNearCounts * count || std::abs(angle.offset) > kNearCounts * count) return;
  if (low > -edge_tolerance && angle.side == Side::kBeforeBlow) angle = {0.0, Side::kAfterBlow};
  if (high < edge_tolerance && angle.side == Side::kAfterBlow) angle = {0.0, Side::kBeforeBlow};
}

bool CrankFilter::isSound() const noexcept {
  return std::isfinite(now_.position.angle.offset) && std::abs(now_.speed) < kSoundSpeeds * settings_.max_speed &&
         std::isfinite(now_.torque) && std::isfinite(now_.drive_inertia) && covariance_.allFinite() &&
         (covariance_.diagonal().array() >= 0.0).all();
}

/// Following it would throw speed and torque far off: 0.3 rad at 1 kHz gave a thousand times the peak force. A crank
/// at constant speed, which the model takes for a heavy one, stays below a kick of 0.35 from 100 Hz on; a slow one may
/// be stopped dead.
bool CrankFilter::isContradiction(double dt, double innovation) const noexcept {
  const double most = std::max(kKick * std::abs(now_.speed), kLearnSpeed) * dt;
  const double total = covariance_(kAngle, kAngle) + encoder_.variance() + square(settings_.angle_noise);
  return std::abs(innovation) > kJump || (std::abs(innovation) > most && square(innovation) > kWiden * total);
}

Tracking CrankFilter::update(double dt, const CrankSample& sample) noexcept {
  const ShaftState last = now_;
  const ShaftMatrix last_covariance = covariance_;
  step_model_.setHullMotion(blend(now_hull_, model_.hullMotion(), 0.5));
  predict(dt, now_, covariance_);

  const double measured = CrankAngle::fromAngle(encoder_.angle(sample.angle)).offset;
  const double innovation = CrankAngle::wrapToPi(measured - now_.position.angle.offset);
  const double deviation = std::sqrt(covariance_(kAngle, kAngle));
  if (!(deviation < kDoubtfulAngle) && has_speed_) {
    if (!isSound()) now_ = last;
    anchor(measured, sample);
    return Tracking::kRestarted;
  }
  if (has_speed_ && isContradiction(dt, innovation)) {
    if (!outlier_seen_) {
      now_ = last;
      covariance_ = last_covariance;
      outlier_seen_ = true;
      return Tracking::kOutlier;
    }
    anchor(measured, {sample.angle, std::nullopt});
    return Tracking::kRestarted;
  }
  before_ = last;
  before_hull_ = now_hull_;
  before_covariance_ = last_covariance;
  step_ = dt;
  outlier_seen_ = false;
  if (std::abs(now_.speed) < kLearnSpeed) forgetInertiaCoupling();
  correctAngle(innovation);
  if (sample.speed) correctSpeed(*sample.speed);
  respectCount(sample.angle);
  if (!isSound()) {
    now_ = last;
    anchor(measured, sample);
    return Tracking::kRestarted;
  }
  load_ = model_(now_.position.angle);
  now_hull_ = model_.hullMotion();
  const bool continued = has_speed_;
  has_speed_ = true;
  return continued ? Tracking::kContinued : Tracking::kRestarted;
}

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  load_ = model_(now_.position.angle);
}

bool CrankFilter::isPlausible() const noexcept {
  return std::abs(now_.torque) <= kMostTorque * settings_.initial_torque_deviation;
}

/// Faster or further than any crank gets within the last step.
bool CrankFilter::hasRunAway(const ShaftState& state) const noexcept {
  const double most_speed = kSoundSpeeds * settings_.max_speed;
  return !(std::abs(state.speed) < most_speed &&
           std::abs(difference(state.position, before_.position)) <= most_speed * step_ + 0.5 * kTwoPi);
}

/// The way forward from the earlier sample and the way back from the later one, each trusted near its own end. Between
/// samples that no machine makes either may run away; it is left out then.
CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  ShaftState state = before_, back = now_;
  ShaftLoad load = step_model_(state.position.angle), back_load = step_model_(back.position.angle);
  advance(step_model_, dt, state, load);
  advance(step_model_, dt - step_, back, back_load);
  const double part = dt / step_;
  if (hasRunAway(state)) {
    state = before_;
    state.position.turn(part * difference(now_.position, before_.position));
  }
  if (hasRunAway(back)) back = state;
  state.position.turn(part * difference(back.position, state.position));
  state.speed += part * (back.speed - state.speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  ShaftModel there = model_;
  there.setHullMotion(blend(before_hull_, now_hull_, dt / step_));
  return {state.position, state.speed, acceleration(there(state.position.angle), state)};
}

Eigen::Matrix3d CrankFilter::covarianceBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return motionCovariance(torque_part);
  ShaftState state = before_;
  ShaftMatrix covariance = before_covariance_;
  predict(dt, state, covariance);
  return motionCovarianceOf(state, covariance, torque_part);
}

/// Linear in the state's deviation; the acceleration's derivative by the angle by a central difference.
Eigen::Matrix3d CrankFilter::motionCovarianceOf(const ShaftState& state, const ShaftMatrix& covariance,
                                                double torque_part) const noexcept {
  const ShaftLoad load = model_(state.position.angle);
  const double inv = 1.0 / (state.drive_inertia + load.inertia);
  constexpr double kStep = 1e-5;  // [rad]: error 1e-10 by curvature, 1e-11 by rounding, both relative
  CrankAngle low = state.position.angle, high = low;
  low.offset -= kStep;
  high.offset += kStep;
  Eigen::Matrix<double, 3, 4> jacobian = Eigen::Matrix<double, 3, 4>::Zero();
  jacobian(0, kAngle) = jacobian(1, kSpeed) = 1.0;
  jacobian(2, kAngle) = (acceleration(model_(high), state) - acceleration(model_(low), state)) / (2.0 * kStep);
  jacobian(2, kSpeed) = -2.0 * load.half_inertia_slope * state.speed * inv;
  jacobian(2, kTorque) = inv * torque_part;
  jacobian(2, kInertia) = -(acceleration(load, state) + load.hull_acceleration) * state.drive_inertia * inv;
  return jacobian * covariance * jacobian.transpose();
}

}  // namespace hammer_loads
