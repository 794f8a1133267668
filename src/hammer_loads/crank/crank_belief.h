/// State and covariance of the crank filter, with their prediction, update and jump at a blow.
#pragma once

#include <cmath>
#include <optional>

#include "hammer_loads/crank/column_step.h"
#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/crank/supply.h"
#include "hammer_loads/estimation/gaussian_belief.h"

namespace hammer_loads {

constexpr double kNoiseStep = 2e-3;  ///< [s] over which the process noise is spread
// Numerical: kNoiseStep
/// Largest change of the inertia's logarithm by one sample: beyond it the linearisation is invalid.
constexpr double kMostInertiaChange = 0.3;

/// Random walks of the variables that are not measured, and the law of the torque.
struct CrankWalks {
  double torque{};   ///< random walk of the net torque [N m/sqrt(s)]
  double speed{};    ///< random walk of the speed [rad/s/sqrt(s)]
  double inertia{};  ///< random walk of the drive inertia, relative [1/sqrt(s)]
  SupplyLaw supply;
};

/// Prior of a blow's factor on the crank's speed, which is independent for each blow.
struct BlowPrior {
  double mean{1.0};    ///< [-], > 0
  double deviation{};  ///< [-]
  ConstantErrors::Row by_error{
      ConstantErrors::Row::Zero()};  ///< d(mean)/d(sensor's errors), as it was learned with them
};

/// Gaussian belief: angle, speed, torque, logarithm of drive inertia, factor of the last blow.
struct CrankBelief : GaussianBelief<5, ConstantErrors::kSize> {
  using Base = GaussianBelief<5, ConstantErrors::kSize>;
  enum Row : Eigen::Index { kAngle, kSpeed, kTorque, kInertia, kFactor };

  ShaftState state;
  double factor{1.0};      ///< factor of the last blow
  double least_inertia{};  ///< bounds of the drive inertia [kg m2]
  double most_inertia{};   ///< upper bound of the drive inertia [kg m2]
  bool tool_met{};         ///< true if the tool was met before the dead centre, where nothing strikes any more
  bool struck_early{};     ///< the last blow's factor acted before the dead centre

  /// Predicts by dt [s] > 0 with random walks; returns the number of blows. Stops at most_speed [rad/s].
  int predict(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& prior, bool contact, double most_speed,
              double dt) noexcept;
  /// Changes its variables. The position may end beyond the blow.
  void move(const Vector& change) noexcept;
  /// Between a blow that stops the crank and one that drives it. Only once a sample has been taken as a whole: the
  /// factor and the speed go together.
  void boundFactor() noexcept;
  /// Scalar measurement of one variable; moves. by_error: what the sensor's errors make of the measurement;
  /// of_constants: their variances where the measurement is to be weighed by them.
  void correct(Row row, double innovation, double variance, const ConstantErrors::Row& by_error,
               const std::optional<ConstantErrors::Row>& of_constants = {}) noexcept;
  /// Removes the correlation with the inertia, so that the next update does not change it.
  void forgetInertiaCoupling() noexcept;
  /// Resets the angle's variance [rad2] and its correlations.
  void forgetAngle(double variance) noexcept;
  /// Passes the blow late, with the position beyond it already.
  void passLate(const ShaftModel& model, const BlowPrior& prior) noexcept;
  /// Adds the uncertainty of a speed that the tool has changed within the last dt [s], relative `deviation`.
  void meetTool(double deviation, double dt) noexcept;
  /// Inflates the variance of the factor of a blow within the last dt [s] until it explains an innovation of variance
  /// `total` of angle or speed. Returns false, without a change, if no factor explains it.
  bool doubtBlow(Row row, double innovation, double total, double dt) noexcept;
  /// Variances of angle, speed and torque, times `by` where that is above 1.
  void widen(double by) noexcept;
  /// Sets the position exactly at the blow.
  void standAtBlow() noexcept { state.position.angle.offset = 0.0; }
  /// Draws a new factor of the blow: sets its prior mean and variance.
  void drawFactor(const BlowPrior& prior) noexcept;
  /// Prior of the next blow at its passage.
  BlowPrior priorOf(const BlowPrior& drawn) const noexcept;
  bool isSound(double most_speed) const noexcept;

  /// State of the encoder: angle from the blow [rad], speed [rad/s], variance and derivative by the sensor's errors of
  /// one of these.
  double encoderOffset() const noexcept { return state.position.angle.offset; }
  double encoderSpeed() const noexcept { return state.speed; }
  double encoderVariance(Row row) const noexcept { return covariance(row, row); }
  ConstantErrors::Row encoderByError(Row row) const noexcept { return by_constant.row(row); }
  /// Factor of the last blow and the inertia on which it acts. growth: factor on noise; root: ConstantErrors::root().
  BlowFactor blowFactor(double growth, const ConstantErrors::Matrix& root) const noexcept;
};

/// load: the model's at the belief's angle; growth, root: as in CrankBelief::blowFactor(); torque_part of the torque's
/// deviation counts.
CrankUncertainty motionUncertainty(const ShaftModel& model, const ShaftLoad& load, const CrankBelief& belief,
                                   double growth, const ConstantErrors::Matrix& root, double torque_part) noexcept;

/// Derivatives by the hammer's constants of the acceleration [rad/s2] at the state itself.
void addAcceleration(const ShaftModel& model, const CrankBelief& belief, double acceleration, double inverse_inertia,
                     CrankUncertainty& result) noexcept;

}  // namespace hammer_loads
