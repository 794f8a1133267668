/// What a Kalman filter whose number of states varies does with its covariance.
#pragma once

#include <Eigen/Core>
#include <array>

namespace hammer_loads {

constexpr int kMostStates = 64;

/// What is in use of a covariance: a square block on its diagonal, of at most kMostStates.
using CovarianceBlock = Eigen::Ref<Eigen::MatrixXd>;

/// P <- P - column column^T/S. S below 0 gives back.
void subtractSquare(CovarianceBlock P, const Eigen::Ref<const Eigen::VectorXd>& column, double S) noexcept;

/// P <- F P F^T, where F makes two states, `first` and the one after it, of five states that hold both of them. P stays
/// symmetric to the last bit.
void replaceTwo(CovarianceBlock P, int first, const std::array<int, 5>& of, const std::array<double, 5>& by_one,
                const std::array<double, 5>& by_other) noexcept;

}  // namespace hammer_loads
