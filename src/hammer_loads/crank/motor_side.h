/// The estimate of the motor beyond a flexible coupling, beside a CrankBelief.
#pragma once

#include "hammer_loads/crank/constant_errors.h"
#include "hammer_loads/crank/flexible_shaft.h"

namespace hammer_loads {

/// Covariance of angle and speed of the motor and of the coupling's stiffness with all variables, and what the
/// constants make of these three. The motor's share is one of the constants.
struct MotorSide {
  enum : Eigen::Index { kAngle, kSpeed, kStiffness, kSize };

  Eigen::Matrix<double, kFlexibleVariables, kSize> covariance{Eigen::Matrix<double, kFlexibleVariables, kSize>::Zero()};
  ByConstants<kSize, ConstantErrors::kSize> by_constant{ByConstants<kSize, ConstantErrors::kSize>::Zero()};
};

}  // namespace hammer_loads
