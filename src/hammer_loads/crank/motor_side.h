/// What is known of the motor beyond a flexible coupling, beside a CrankBelief.
#pragma once

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/flexible_shaft.h"

namespace hammer_loads {

/// Covariance of the last four variables of FlexibleMatrix with all of them, and what the sensor's errors make of
/// these four.
struct MotorSide {
  enum : Eigen::Index { kAngle, kSpeed, kStiffness, kOdds };
  using Covariance = Eigen::Matrix<double, 9, 4>;
  using Effect = Eigen::Matrix<double, 4, ConstantErrors::kSize>;

  using Odds = Eigen::Matrix<double, 9, 1>;

  Covariance covariance{Covariance::Zero()};
  Effect by_error{Effect::Zero()};
  /// d(all variables)/d(logarithm of the odds): a wrong share is not corrected; the filter runs as if it were right,
  /// and knows beside its state what an error of it would do.
  Odds by_odds{Odds::Unit(8)};
  double odds_variance{};  ///< of that logarithm
};

/// What the doubt in the motor's share adds to the covariance of a CrankBelief's variables.
ShaftMatrix effectOfShare(const MotorSide& motor) noexcept;

}  // namespace hammer_loads
