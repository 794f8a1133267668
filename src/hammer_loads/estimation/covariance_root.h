/// A covariance as errors that are independent of each other.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace hammer_loads {

/// L with L L^T = covariance, lower triangular, also where some error is certain to be zero: its columns are errors of
/// one standard deviation each.
template <int size>
Eigen::Matrix<double, size, size> covarianceRoot(const Eigen::Matrix<double, size, size>& covariance) noexcept {
  constexpr double kRounding = 1e-12;  // relative, for a variance: a smaller pivot is a rounded zero
  // Numerical: kRounding
  Eigen::Matrix<double, size, size> root = Eigen::Matrix<double, size, size>::Zero();
  for (Eigen::Index j = 0; j < size; ++j) {
    const double pivot = covariance(j, j) - root.row(j).head(j).squaredNorm();
    if (!(pivot > kRounding * covariance(j, j))) continue;
    root(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < size; ++i)
      root(i, j) = (covariance(i, j) - root.row(i).head(j).dot(root.row(j).head(j))) / root(j, j);
  }
  return root;
}

/// The way back: of errors that are independent of each other, a column each. Symmetric to the last bit.
template <int size>
Eigen::Matrix<double, size, size> covarianceOf(const Eigen::Matrix<double, size, size>& errors) noexcept {
  const Eigen::Matrix<double, size, size, Eigen::RowMajor> rows = errors;
  Eigen::Matrix<double, size, size> covariance;
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k <= i; ++k) covariance(i, k) = covariance(k, i) = rows.row(i).dot(rows.row(k));
  return covariance;
}

}  // namespace hammer_loads
