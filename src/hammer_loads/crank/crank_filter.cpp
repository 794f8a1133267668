#include "hammer_loads/crank/crank_filter.h"

#include <cmath>

namespace hammer_loads {

CrankFilter::CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings)
    : model_(model), settings_(settings) {
  state_.drive_inertia = drive_inertia;
  covariance_.setZero();
  covariance_(3, 3) = std::pow(settings.initial_inertia_deviation * drive_inertia, 2);
}

void CrankFilter::start(const CrankSample& s) noexcept {
  const double q = settings_.angle_resolution;
  state_.position = {0, CrankAngle::fromAngle(s.angle + 0.5 * q)};
  state_.speed = s.speed.value_or(0.0);
  state_.torque = 0;
  double pj = covariance_(3, 3);
  covariance_.setZero();
  covariance_(0, 0) = q * q / 12;
  covariance_(1, 1) = std::pow(s.speed ? settings_.speed_noise : 20.0, 2);
  covariance_(2, 2) = std::pow(settings_.initial_torque_deviation, 2);
  covariance_(3, 3) = pj;
}

void CrankFilter::predict(double dt) noexcept {
  // halves
  const double total = state_.drive_inertia + model_(state_.position.angle).inertia;
  const ShaftMatrix f = advance(model_, dt, state_);
  const double qt = settings_.torque_walk * settings_.torque_walk, qw = settings_.speed_walk * settings_.speed_walk;
  covariance_ = f * covariance_ * f.transpose();
  const double b = 1.0 / total;
  covariance_(1, 1) += qw * dt + qt * b * b * dt * dt * dt / 3;
  covariance_(0, 0) += qw * dt * dt * dt / 3;
  covariance_(0, 1) += qw * dt * dt / 2;
  covariance_(1, 0) += qw * dt * dt / 2;
  covariance_(1, 2) += qt * b * dt * dt / 2;
  covariance_(2, 1) += qt * b * dt * dt / 2;
  covariance_(2, 2) += qt * dt;
  covariance_(3, 3) += settings_.inertia_walk * settings_.inertia_walk * dt;
}

void CrankFilter::correct(int row, double innovation, double variance) noexcept {
  const double s = covariance_(row, row) + variance;
  const Eigen::Vector4d gain = covariance_.col(row) / s;
  const Eigen::Vector4d d = gain * innovation;
  (row == 0 ? nis_angle : nis_speed) = innovation * innovation / s;
  state_.position.turn(d[0]);
  state_.speed += d[1];
  state_.torque += d[2];
  state_.drive_inertia += d[3];
  if (state_.drive_inertia < 1e-6) state_.drive_inertia = 1e-6;
  const Eigen::RowVector4d r = covariance_.row(row);
  covariance_ -= gain * r;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

void CrankFilter::update(double dt, const CrankSample& s) noexcept {
  before_state = state_;
  const double q = settings_.angle_resolution;
  int n = std::max(1, int(std::ceil(dt / 0.002)));
  for (int i = 0; i < n; ++i) predict(dt / n);
  prior_state = state_;
  last_dt = dt;
  const CrankAngle z = CrankAngle::fromAngle(s.angle + 0.5 * q);
  const double innovation = CrankAngle::wrapToPi(z.offset - state_.position.angle.offset);
  const double w0 = state_.speed;
  const double c0 = covariance_(0, 0);
  (void)w0; (void)c0;
  if (dt > 0.05) {  // anew
    state_.position.turn(innovation);
    covariance_.row(0).setZero(); covariance_.col(0).setZero();
    covariance_.row(1).setZero(); covariance_.col(1).setZero();
    covariance_.row(2).setZero(); covariance_.col(2).setZero();
    covariance_(0, 0) = q * q / 12;
    covariance_(1, 1) = std::pow(settings_.speed_noise, 2);
    covariance_(2, 2) = std::pow(settings_.initial_torque_deviation, 2);
    if (s.speed) state_.speed = *s.speed;
    return;
  }
  correct(0, innovation, q * q / 12 + settings_.angle_noise * settings_.angle_noise);
  if (s.speed) correct(1, *s.speed - state_.speed, settings_.speed_noise * settings_.speed_noise);
}

}  // namespace hammer_loads
