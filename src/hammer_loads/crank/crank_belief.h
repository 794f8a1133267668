/// State and covariance of the crank filter: what a prediction, a measurement and a blow do to them.
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

/// The prior of a blow: the factor on the crank's speed is drawn each time.
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
  bool tool_met{};         ///< before the dead centre: nothing strikes there any more
  bool struck_early{};     ///< the last blow's factor acted before the dead centre
  NearColumns near;        ///< columns of the hammer, where the state was last predicted

  /// By dt [s] > 0 with the walks of the meantime; how many blows were struck. Stops at most_speed [rad/s].
  int predict(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& prior, bool contact, double most_speed,
              double dt) noexcept;
  /// By a change of its variables. Slides the position; it may end beyond the blow.
  void move(const Vector& change) noexcept;
  /// Between a blow that stops the crank and one that drives it. Only once a sample has been taken as a whole: the
  /// factor and the speed go together.
  void boundFactor() noexcept;
  /// Scalar measurement of one variable; moves. by_error: what the sensor's errors make of the measurement;
  /// of_constants: their variances where the measurement is to be weighed by them.
  void correct(Row row, double innovation, double variance, const ConstantErrors::Row& by_error,
               const std::optional<ConstantErrors::Row>& of_constants = {}) noexcept;
  /// The coming correction teaches nothing of the inertia.
  void forgetInertiaCoupling() noexcept;
  /// Nothing is known of the angle beyond a variance [rad2] about the present one.
  void forgetAngle(double variance) noexcept;
  /// The position stands beyond the blow that it should have passed: passes it now.
  void passLate(const ShaftModel& model, const BlowPrior& prior) noexcept;
  /// The tool was met some time within the last dt [s]: the speed is uncertain by `deviation` of itself.
  void meetTool(double deviation, double dt) noexcept;
  /// Just after a blow, struck some time within the last dt [s]: its factor is uncertain by as much as explains an
  /// innovation of variance `total` of angle or speed. False: no factor explains it, all stays.
  bool doubtBlow(Row row, double innovation, double total, double dt) noexcept;
  /// Variances of angle, speed and torque, times `by` where that is above 1.
  void widen(double by) noexcept;
  /// Stands exactly at the blow.
  void standAtBlow() noexcept { state.position.angle.offset = 0.0; }
  /// A blow's factor and its variance are drawn.
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
  /// Factor of the last blow and the inertia that it acts on. growth: what noise is to be multiplied with; root:
  /// ConstantErrors::root().
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
