/// Kalman filter on the mechanism: from noisy crank samples to angle, speed, acceleration, torque and drive inertia.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {

/// One crank sample as measured.
struct CrankSample {
  double angle{};               ///< any winding [rad]
  std::optional<double> speed;  ///< [rad/s]
};

/// What the filter assumes about sensors and supply.
struct CrankFilterSettings {
  double angle_resolution{};        ///< encoder count [rad], > 0: a sample means [angle, angle + resolution)
  double angle_noise{};             ///< standard deviation beside the count [rad], >= 0
  double speed_noise{};             ///< standard deviation of a measured speed [rad/s], > 0
  double torque_walk{};             ///< random walk of the net torque [N m/sqrt(s)]
  double speed_walk{};              ///< random walk of the speed [rad/s/sqrt(s)]
  double inertia_walk{};            ///< random walk of the drive inertia [kg m2/sqrt(s)]
  double initial_torque_deviation{};    ///< [N m]
  double initial_inertia_deviation{};   ///< relative to the configured drive inertia [-]
};

/// State: angle, speed, net torque, drive inertia (model.md 6). Predicts with advance(), corrects with each sample.
class CrankFilter {
 public:
  CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings);

  /// Forgets everything but the identified inertia and starts at a sample.
  void start(const CrankSample& sample) noexcept;
  /// dt > 0 [s] since the last sample or start.
  void update(double dt, const CrankSample& sample) noexcept;
  void setGravity(Gravity gravity) noexcept { model_.setGravity(gravity); }

  const ShaftState& state() const noexcept { return state_; }
  const ShaftMatrix& covariance() const noexcept { return covariance_; }
  const ShaftModel& model() const noexcept { return model_; }
  double acceleration() const noexcept {
    return hammer_loads::acceleration(model_(state_.position.angle), state_);
  }

  ShaftState prior_state, before_state; double last_dt{};
  double nis_angle{}, nis_speed{};
 public:
  void predict(double dt) noexcept;
  void correct(int row, double innovation, double variance) noexcept;

  ShaftModel model_;
  CrankFilterSettings settings_;
  ShaftState state_;
  ShaftMatrix covariance_;
};

}  // namespace hammer_loads
