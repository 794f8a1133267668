/// Belief of the crank filter: state and covariance, their prediction, update and jump at a blow; the samples that
/// update it, the prior of a blow, and the estimate between two samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/gaussian_belief.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

constexpr double kNoiseStep = 2e-3;  ///< largest step with its own process noise [s]
// Numerical: kNoiseStep
/// Largest change of the inertia's logarithm by one sample: beyond it the linearisation is invalid.
constexpr double kMostInertiaChange = 0.3;
// Numerical: kMostInertiaChange

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
      ConstantErrors::Row::Zero()};  ///< d(mean)/d(sensor's errors), since it was identified with them
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
  bool struck_early{};     ///< true if the factor of the last blow acted before the dead centre

  /// Predicts by dt [s] > 0 with random walks; returns the number of blows. load: load of the model at the belief's
  /// angle. Stops at most_speed [rad/s].
  int predict(const ShaftModel& model, ShaftLoad load, const CrankWalks& walks, const BlowPrior& prior, bool contact,
              double most_speed, double dt) noexcept;
  /// Adds a change to the variables; the position may then lie beyond the blow.
  void move(const Vector& change) noexcept;
  /// Bounds the factor between that of a blow that stops the crank and that of one that drives it. To be called after a
  /// sample has been used completely, since factor and speed change together.
  void boundFactor() noexcept;
  /// Corrects by a scalar measurement of one variable. by_error: derivative of the measurement by the sensor's errors;
  /// of_constants: variances of these errors if they reduce the measurement's weight.
  void correct(Row row, double innovation, double variance, const ConstantErrors::Row& by_error,
               const std::optional<ConstantErrors::Row>& of_constants = {}) noexcept;
  /// Removes the correlation with the inertia, so that the next update does not change it.
  void forgetInertiaCoupling() noexcept;
  /// Resets the angle's variance [rad2] and its correlations.
  void forgetAngle(double variance) noexcept;
  /// Passes the blow late, when the position is already beyond it.
  void passLate(const ShaftModel& model, const BlowPrior& prior) noexcept;
  /// Adds the uncertainty of a speed that the tool has changed within the last dt [s], relative `deviation`.
  void meetTool(double deviation, double dt) noexcept;
  /// Inflates the variance of the factor of a blow within the last dt [s] until it explains an innovation of variance
  /// `total` of angle or speed. Returns false, without a change, if no factor explains it.
  bool inflateBlow(Row row, double innovation, double total, double dt) noexcept;
  /// Multiplies the variances of angle, speed and torque by `by` if that is above 1.
  void widen(double by) noexcept;
  /// Sets the position exactly at the blow.
  void stopAtBlow() noexcept { state.position.angle.offset = 0.0; }
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

/// load: load of the model at the belief's angle; growth, root: as in CrankBelief::blowFactor(); torque_part: part of
/// the torque's standard deviation that counts.
CrankUncertainty motionUncertainty(const ShaftModel& model, const ShaftLoad& load, const CrankBelief& belief,
                                   double growth, const ConstantErrors::Matrix& root, double torque_part) noexcept;

/// Adds the derivatives of the acceleration [rad/s2] by the hammer's constants, at a fixed state.
void addAcceleration(const ShaftModel& model, const CrankBelief& belief, double acceleration, double inverse_inertia,
                     CrankUncertainty& result) noexcept;

/// Mean and variance of the blows' factors, weighted towards the last ten. If all blows of a machine are alike, the
/// next one is known before any sample; otherwise the variance remains as large as the scatter.
class BlowHistory {
 public:
  explicit BlowHistory(const BlowPrior& first) noexcept
      : first_(first),
        mean_(kLength, first.mean, kFirstCounts),
        variance_(kLength, first.deviation * first.deviation, kFirstCounts),
        by_error_(kLength, ConstantErrors::Row::Zero(), kFirstCounts) {}

  /// Adds the factor of a blow, its variance and its derivative by the sensor's errors, estimated from all samples
  /// since.
  void add(double factor, double variance, const ConstantErrors::Row& by_error) noexcept {
    const double bound = square(gate::kUsual) * variance;
    if (!(bound < variance_.mean() || variance < square(kLeast))) return;  // the samples contain no information on it
    variance_.add(square(factor - mean_.mean()));
    mean_.add(factor);
    by_error_.add(by_error);
  }

  BlowPrior prior() const noexcept {
    return {mean_.mean(), std::clamp(std::sqrt(variance_.mean()), std::min(kLeast, first_.deviation), kMost),
            by_error_.mean()};
  }

 private:
  /// Weight of the first guess in blows; a small weight lets a wrong conclusion from the first few blows show at once.
  static constexpr double kFirstCounts = 0.1, kLength = 10.0 + kFirstCounts;
  static constexpr double kLeast = 0.01;  // lower bound of the standard deviation
  static constexpr double kMost = 0.3;
  // Prior: kLeast, kMost
  BlowPrior first_;
  RunningMean<> mean_, variance_;
  RunningMean<ConstantErrors::Row> by_error_;
};

/// A measurement less its prediction.
struct Innovation {
  double value{};                                             ///< measured less predicted
  double total{};                                             ///< variance of the innovation
  double variance{};                                          ///< the measurement's part of the variance
  ConstantErrors::Row by_error{ConstantErrors::Row::Zero()};  ///< d(measured)/d(sensor's errors)

  double ratio() const noexcept { return value * value / total; }
  bool exceeds(double deviations) const noexcept { return hammer_loads::exceeds(value, total, deviations); }
  /// Logarithm of the likelihood, without a constant.
  double logLikelihood() const noexcept { return -0.5 * (ratio() + std::log(total)); }
};

struct WeighedSample {
  double angle{};               ///< from the nearest blow [rad]
  std::optional<double> speed;  ///< [rad/s]
  double angle_variance{};      ///< variance of count and noise [rad2]
  double timing_variance{};     ///< variance of the stamp [s2]
  double speed_variance{};      ///< variance of the speed's noise [rad2/s2]
  /// Variances of the constants that reduce the weight of a speed; empty: none.
  std::optional<ConstantErrors::Row> of_speed{};

  /// Variance of the angle including the error of the stamp [rad2].
  double angleVariance(double speed_there) const noexcept {
    return angle_variance + speed_there * speed_there * timing_variance;
  }
  /// Returns true if its instant is less certain than the angle of the crank.
  bool isUnsureOfTime(double speed_there) const noexcept {
    return speed_there * speed_there * timing_variance > angle_variance;
  }
  Innovation ofAngle(const CrankBelief& belief) const noexcept;
  /// Innovation of the speed. Precondition: a speed was measured.
  Innovation ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept;
};

inline Innovation WeighedSample::ofAngle(const CrankBelief& belief) const noexcept {
  const double offset = belief.encoderOffset(), variance = angleVariance(belief.encoderSpeed());
  return {CrankAngle::wrapToPi(angle - offset), belief.encoderVariance(CrankBelief::kAngle) + variance, variance,
          ConstantErrors::ofAngle({offset, belief.encoderSpeed(), 0.0})};
}

/// An error of the stamp changes the speed by that error times the acceleration.
inline Innovation WeighedSample::ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept {
  const ShaftState& state = belief.state;
  const ShaftLoad load = model(state.position.angle);
  const double change = acceleration(load, state);
  const double noise = speed_variance + square(change) * timing_variance;
  const auto by_error = ConstantErrors::ofSpeed({belief.encoderOffset(), belief.encoderSpeed(), change});
  const double of_constants =
      of_speed ? double{(by_error - belief.encoderByError(CrankBelief::kSpeed)).cwiseAbs2().dot(*of_speed)} : 0.0;
  return {*speed - belief.encoderSpeed(), belief.encoderVariance(CrankBelief::kSpeed) + noise + of_constants, noise,
          by_error};
}

/// Returns the estimate of a state. load: load of the model there.
inline CrankEstimate estimateOf(const ShaftLoad& load, const ShaftState& state) noexcept {
  return {state.position, state.speed, acceleration(load, state)};
}

/// Two samples and the step between them; refers to its arguments.
struct BetweenSamples {
  const ShaftModel& model;
  const ShaftModel& step_model;  ///< with the hull's mean motion over the step
  const CrankBelief& before;
  const CrankBelief& now;
  const HullMotion& before_hull;  ///< at the samples
  const HullMotion& now_hull;
  double step{};        ///< [s]
  double most_speed{};  ///< speed from which on an estimate has diverged [rad/s]
};

/// Returns the weighted mean of the prediction forward from the earlier sample and backward from the later one, each
/// with more weight near its own end. A diverging prediction between impossible samples is left out. dt: time after the
/// earlier sample, less than the step [s].
CrankEstimate estimateBetween(const BetweenSamples& samples, double dt) noexcept;

/// Returns the crank by both paths at the place between, each with its own speed and torque; empty if one diverged.
std::optional<CrankPaths> pathsBetween(const BetweenSamples& samples, double dt) noexcept;

}  // namespace hammer_loads
