#include "hammer_loads/crank/crank_filter.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

enum Row : Eigen::Index { kAngle, kSpeed, kTorque, kInertia };

constexpr double kWiden = 25.0;          // innovation^2 over its variance from which on the model does not explain it
constexpr double kDoubtfulAngle = 0.3;   // [rad] predicted deviation from which on the prediction is worth nothing
constexpr double kJump = 0.5;            // [rad] innovation that no working machine makes between two samples
constexpr double kNoiseStep = 2e-3;      // [s] step over which the process noise is spread
constexpr double kMaxInertiaChange = 0.3;   // of the logarithm by one sample: beyond it the linearisation is worth nothing
constexpr double kSpeedNoiseGain = 0.005;   // per sample: the noise of measured speeds is learned within some 200
constexpr double kLeastSpeedNoise = 0.3;    // of the first guess

double square(double x) noexcept { return x * x; }

}  // namespace

CrankFilter::CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings)
    : model_(model), settings_(settings), encoder_(settings.angle_resolution),
      speed_variance_(square(settings.speed_noise)) {
  now_.drive_inertia = drive_inertia;
  covariance_.setZero();
  covariance_(kInertia, kInertia) = square(settings.initial_inertia_deviation);
}

void CrankFilter::start(const CrankSample& sample) noexcept {
  now_.position = {0, CrankAngle::fromAngle(encoder_.angle(sample.angle))};
  now_.speed = 0.0;
  now_.torque = 0.0;
  anchor(0.0, sample);
}

/// Takes angle and speed from the sample alone; the torque is in doubt, the inertia stays as identified.
void CrankFilter::anchor(double angle_innovation, const CrankSample& sample) noexcept {
  const double inertia_variance = covariance_(kInertia, kInertia);  // NaN-proof by min: never above the first guess
  now_.position.turn(angle_innovation);
  now_.speed = sample.speed.value_or(now_.speed);
  has_speed_ = sample.speed.has_value();
  outlier_seen_ = false;
  covariance_.setZero();
  covariance_(kAngle, kAngle) = encoder_.variance() + square(settings_.angle_noise);
  covariance_(kSpeed, kSpeed) = has_speed_ ? speed_variance_ : square(settings_.max_speed);
  covariance_(kTorque, kTorque) = square(settings_.initial_torque_deviation);
  covariance_(kInertia, kInertia) = std::min(square(settings_.initial_inertia_deviation), inertia_variance);
}

void CrankFilter::predict(double dt) noexcept {
  const double b = 1.0 / (now_.drive_inertia + model_(now_.position.angle).inertia);
  const ShaftMatrix f = advance(model_, dt, now_);
  const double torque = square(settings_.torque_walk) * dt, speed = square(settings_.speed_walk) * dt;
  covariance_ = (f * covariance_ * f.transpose()).eval();
  covariance_(kAngle, kAngle) += speed * dt * dt / 3.0;
  covariance_(kSpeed, kSpeed) += speed + torque * square(b * dt) / 3.0;
  covariance_(kTorque, kTorque) += torque;
  covariance_(kInertia, kInertia) += square(settings_.inertia_walk) * dt;
  const double angle_speed = 0.5 * speed * dt, speed_torque = 0.5 * torque * b * dt;
  covariance_(kAngle, kSpeed) += angle_speed;
  covariance_(kSpeed, kAngle) += angle_speed;
  covariance_(kSpeed, kTorque) += speed_torque;
  covariance_(kTorque, kSpeed) += speed_torque;
}

/// Scalar measurement of one state variable.
void CrankFilter::correct(Eigen::Index row, double innovation, double variance) noexcept {
  const double total = covariance_(row, row) + variance;
  const Eigen::Vector4d column = covariance_.col(row);
  const Eigen::Vector4d change = column * (innovation / total);
  now_.position.turn(change[kAngle]);
  now_.speed += change[kSpeed];
  now_.torque += change[kTorque];
  now_.drive_inertia *= std::exp(std::clamp(change[kInertia], -kMaxInertiaChange, kMaxInertiaChange));
  covariance_.noalias() -= column * (column.transpose() / total);
}

void CrankFilter::correctAngle(double innovation) noexcept {
  const double variance = encoder_.variance() + square(settings_.angle_noise);
  const double squared = innovation * innovation;
  if (squared > kWiden * (covariance_(kAngle, kAngle) + variance)) {
    const double factor = (0.25 * squared - variance) / covariance_(kAngle, kAngle);
    covariance_.topLeftCorner<3, 3>() *= factor;
    covariance_.topRightCorner<3, 1>().setZero();
    covariance_.bottomLeftCorner<1, 3>().setZero();
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

bool CrankFilter::isSound() const noexcept {
  return std::isfinite(now_.position.angle.offset) && std::isfinite(now_.speed) && std::isfinite(now_.torque) &&
         std::isfinite(now_.drive_inertia) && covariance_.allFinite() && (covariance_.diagonal().array() >= 0.0).all();
}

Tracking CrankFilter::update(double dt, const CrankSample& sample) noexcept {
  const ShaftState last = now_;
  const ShaftMatrix last_covariance = covariance_;
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kNoiseStep)));
  for (int i = 0; i < steps; ++i) predict(dt / steps);

  const double measured = CrankAngle::fromAngle(encoder_.angle(sample.angle)).offset;
  const double innovation = CrankAngle::wrapToPi(measured - now_.position.angle.offset);
  const double deviation = std::sqrt(covariance_(kAngle, kAngle));
  if (!(deviation < kDoubtfulAngle) && has_speed_) {
    anchor(innovation, sample);
    return Tracking::kRestarted;
  }
  if (has_speed_ && std::abs(innovation) > kJump) {
    if (!outlier_seen_) {
      now_ = last;
      covariance_ = last_covariance;
      outlier_seen_ = true;
      return Tracking::kOutlier;
    }
    anchor(innovation, sample);
    return Tracking::kRestarted;
  }
  before_ = last;
  predicted_ = now_;
  step_ = dt;
  outlier_seen_ = false;
  correctAngle(innovation);
  if (sample.speed) correctSpeed(*sample.speed);
  if (!isSound()) {
    now_ = last;
    anchor(CrankAngle::wrapToPi(measured - now_.position.angle.offset), sample);
    return Tracking::kRestarted;
  }
  const bool continued = has_speed_;
  has_speed_ = true;
  return continued ? Tracking::kContinued : Tracking::kRestarted;
}

CrankEstimate CrankFilter::estimateOf(const ShaftState& state) const noexcept {
  return {state.position, state.speed, acceleration(model_(state.position.angle), state)};
}

/// Prediction from the earlier sample, led linearly to what the later sample made of it.
CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  ShaftState state = before_;
  advance(model_, dt, state);
  const double part = dt / step_;
  state.position.turn(part * difference(now_.position, predicted_.position));
  state.speed += part * (now_.speed - predicted_.speed);
  state.torque += part * (now_.torque - predicted_.torque);
  state.drive_inertia += part * (now_.drive_inertia - predicted_.drive_inertia);
  return estimateOf(state);
}

}  // namespace hammer_loads
