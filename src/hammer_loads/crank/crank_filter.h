/// Kalman filter on the mechanism: from noisy crank samples to angle, speed, acceleration, torque and drive inertia.
#pragma once

#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/crank/encoder.h"

namespace hammer_loads {

/// What the filter assumes about sensors and supply.
struct CrankFilterSettings {
  double angle_resolution{};           ///< encoder count [rad], > 0
  double angle_noise{};                ///< standard deviation beside the count [rad], >= 0
  double speed_noise{};                ///< standard deviation of a measured speed, first guess [rad/s], > 0
  double torque_walk{};                ///< random walk of the net torque [N m/sqrt(s)], > 0
  double speed_walk{};                 ///< random walk of the speed [rad/s/sqrt(s)], > 0
  double inertia_walk{};               ///< relative random walk of the drive inertia [1/sqrt(s)], >= 0
  double initial_torque_deviation{};   ///< [N m], > 0
  double initial_inertia_deviation{};  ///< relative [-], >= 0
  double max_speed{};                  ///< bound of an unknown speed [rad/s], > 0
};

/// Extended Kalman filter, state: angle, speed, net torque, drive inertia (model.md 6). The step between samples and
/// its linearisation are advance()'s, through the blow as well. The inertia identifies itself within a few turns, the
/// noise of measured speeds within some hundred samples.
///
/// An angle that the model cannot explain within 5 standard deviations widens the filter's uncertainty until it can: a
/// supply that behaves otherwise than a slow random walk is followed with less smoothing, not refused, and teaches
/// nothing of the inertia. A speed that far off is not used. Where following the angle would change the speed by a
/// third, the sample is an outlier; a second one in a row is believed, and begins anew without the speed it tells.
class CrankFilter final : public CrankTracker {
 public:
  /// drive_inertia: first guess [kg m2], > 0.
  CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings);

  /// The step up to the coming sample is predicted with the mean of this and the last sample's.
  void setHullMotion(const HullMotion& hull) noexcept override;

  void start(const CrankSample& sample) noexcept override;
  Tracking update(double dt, const CrankSample& sample) noexcept override;
  CrankEstimate estimate() const noexcept override { return {now_.position, now_.speed, acceleration(load_, now_)}; }
  CrankEstimate between(double dt) const noexcept override;
  Eigen::Matrix3d covarianceBetween(double dt, double torque_part) const noexcept override;
  Eigen::Matrix3d motionCovariance(double torque_part) const noexcept override {
    return motionCovarianceOf(now_, covariance_, torque_part);
  }
  bool hasSpeed() const noexcept override { return has_speed_; }
  bool isPlausible() const noexcept override;

  const ShaftState& state() const noexcept { return now_; }
  /// Covariance of (angle, speed, torque, logarithm of drive inertia) at the last accepted sample.
  const ShaftMatrix& covariance() const noexcept { return covariance_; }
  const Encoder& encoder() const noexcept { return encoder_; }
  double speedNoise() const noexcept { return std::sqrt(speed_variance_); }  ///< of measured speeds, identified [rad/s]

 private:
  Eigen::Matrix3d motionCovarianceOf(const ShaftState& state, const ShaftMatrix& covariance,
                                     double torque_part) const noexcept;
  void predict(double dt, ShaftState& state, ShaftMatrix& covariance) const noexcept;
  void forgetInertiaCoupling() noexcept;
  void correctAngle(double innovation) noexcept;
  void correctSpeed(double measured) noexcept;
  void correct(Eigen::Index row, double innovation, double variance) noexcept;
  void respectCount(double reading) noexcept;
  bool isContradiction(double dt, double innovation) const noexcept;
  bool isSound() const noexcept;
  bool hasRunAway(const ShaftState& state) const noexcept;
  void anchor(double measured, const CrankSample& sample) noexcept;

  ShaftModel model_;        ///< with the latest motion of the hull
  ShaftModel step_model_;   ///< with its mean over the step between the last two samples
  HullMotion now_hull_;     ///< at the last sample
  HullMotion before_hull_;  ///< at the last but one sample
  CrankFilterSettings settings_;
  double first_guess_;  ///< of the drive inertia [kg m2]
  Encoder encoder_;
  ShaftState now_;                 ///< at the last sample, corrected by it
  ShaftLoad load_;                 ///< there
  ShaftState before_;              ///< at the last but one sample
  double step_{};                  ///< between these two [s]
  ShaftMatrix covariance_;         ///< at the last sample
  ShaftMatrix before_covariance_;  ///< at the last but one sample
  double speed_variance_;          ///< of measured speeds, as identified [rad2/s2]
  bool has_speed_{};
  bool outlier_seen_{};
};

}  // namespace hammer_loads
