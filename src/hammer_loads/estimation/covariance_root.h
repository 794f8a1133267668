/// Conversion between a covariance and errors that are independent of each other.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace hammer_loads {

/// Returns lower triangular L with L L^T = covariance, also where some error is certain to be zero. Its columns are
/// errors of one standard deviation each.
template <int size>
Eigen::Matrix<double, size, size> covarianceRoot(const Eigen::Matrix<double, size, size>& covariance) noexcept {
  constexpr double kRounding = 1e-12;  // relative to a variance: a smaller pivot is a rounded zero
  // Numerical: kRounding
  Eigen::Matrix<double, size, size, Eigen::RowMajor> root = Eigen::Matrix<double, size, size>::Zero();
  for (Eigen::Index j = 0; j < size; ++j) {
    const auto rest = [&](Eigen::Index i) {  // scalars: blocks of variable size cost twice as much
      double sum = covariance(i, j);
      for (Eigen::Index k = 0; k < j; ++k) sum -= root(i, k) * root(j, k);
      return sum;
    };
    const double pivot = rest(j);
    if (!(pivot > kRounding * covariance(j, j))) continue;
    root(j, j) = std::sqrt(pivot);
    const double inverse = 1.0 / root(j, j);
    for (Eigen::Index i = j + 1; i < size; ++i) root(i, j) = inverse * rest(i);
  }
  return root;
}

/// Returns the covariance of some numbers, a row each, by independent errors, a column each. It is symmetric to the
/// last bit.
template <typename Errors>
auto covarianceOf(const Eigen::MatrixBase<Errors>& errors) noexcept {
  Eigen::Matrix<double, Errors::RowsAtCompileTime, Errors::RowsAtCompileTime> covariance;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    for (Eigen::Index k = 0; k <= i; ++k)
      covariance(i, k) = covariance(k, i) = double{errors.row(i).dot(errors.row(k))};
  return covariance;
}

}  // namespace hammer_loads
