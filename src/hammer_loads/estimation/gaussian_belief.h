/// Gaussian belief about some variables beside constants that are not known exactly: covariance and effect of the
/// constants.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/util/by_constants.h"

namespace hammer_loads {

/// Schmidt's consider filter (Friedland's separate bias). The `variables` x are corrected; the errors p of the
/// `constants` are not. The owner keeps the mean of x, which may be on a circle or bounded. Its error is
///
///     mean - x = e + V p,  e ~ N(0, P) independent of p,
///
/// with the covariance P for correct constants and V = d(mean)/dp. For any covariance of p, known now or later, the
/// covariance of the mean's error is P + V cov(p) V^T. An innovation is (dz/dp - H V) p plus noise;
/// ConstantFit estimates p from it.
///
/// Fixed sizes, no allocation, nothing throws. P stays symmetric to the last bit.
template <int variables, int constants, typename Scalar = float>
struct GaussianBelief {
  using Vector = Eigen::Matrix<double, variables, 1>;
  using Row = Eigen::Matrix<double, 1, variables>;  ///< derivative of a number by the variables
  using Matrix = Eigen::Matrix<double, variables, variables>;
  using Effect = ByConstants<variables, constants, Scalar>;
  using ConstantRow = ByConstants<1, constants, Scalar>;  ///< derivative of a number by the constants

  Matrix covariance{Matrix::Zero()};   ///< P
  Effect by_constant{Effect::Zero()};  ///< V

  /// Predicts by a transition F = d(after)/d(before) that is the identity except for some rows; f: these, in the order
  /// of `rows`. P <- F P F^T, V <- F V.
  template <Eigen::Index... rows>
  void predict(const Eigen::Matrix<double, int{sizeof...(rows)}, variables>& f) noexcept {
    constexpr Eigen::Index changed[] = {rows...};
    constexpr int count = sizeof...(rows);
    const Eigen::Matrix<double, count, variables> moved = f * covariance;
    const Eigen::Matrix<double, count, count> both = moved * f.transpose();
    const ByConstants<count, constants, Scalar> effect = f.template cast<Scalar>().lazyProduct(by_constant);
    for (int i = 0; i < count; ++i) {
      covariance.row(changed[i]) = moved.row(i);
      covariance.col(changed[i]) = moved.row(i).transpose();
      by_constant.row(changed[i]) = effect.row(i);
    }
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k <= i; ++k) covariance(changed[i], changed[k]) = covariance(changed[k], changed[i]) = both(i, k);
    }
  }
  /// Adds independent noise to the covariance of two variables, or to the variance of one.
  void addNoise(Eigen::Index i, Eigen::Index k, double value) noexcept {
    covariance(i, k) += value;
    if (i != k) covariance(k, i) = covariance(i, k);
  }

  /// Corrects by a measurement of one variable with noise of a variance >= 0. measured_by_constant: derivative of the
  /// reading by the constants. Returns the gain; the owner moves its mean by gain times innovation.
  Vector correct(Eigen::Index row, double variance, const ConstantRow& measured_by_constant) noexcept {
    const Vector column = covariance.col(row), gain = column / (covariance(row, row) + variance);
    applyGain(gain, column, variance, measured_by_constant - by_constant.row(row));
    // K R is the covariance with a measured variable; the difference of large numbers would lose it.
    covariance.row(row) = variance * gain.transpose();
    covariance.col(row) = variance * gain;
    return gain;
  }
  /// Corrects by a measurement that depends on several variables by `seen`, which is H.
  Vector correct(const Row& seen, double variance, const ConstantRow& measured_by_constant) noexcept {
    const Vector column = covariance * seen.transpose(), gain = column / (seen.dot(column) + variance);
    applyGain(gain, column, variance, measured_by_constant - seen.template cast<Scalar>() * by_constant);
    return gain;
  }
  /// Corrects by a measurement of one variable where the constants have these variances, independent of each other.
  /// Schmidt's gain gives the least total error without a correction of the constants. A variance of 0, or none at all,
  /// stands for a correct constant.
  Vector correct(Eigen::Index row, double variance, const ConstantRow& measured_by_constant,
                 const std::optional<ConstantRow>& of_constants) noexcept {
    if (!of_constants) return correct(row, variance, measured_by_constant);
    const ConstantRow seen = measured_by_constant - by_constant.row(row), weighed = seen.cwiseProduct(*of_constants);
    const Vector column = covariance.col(row);
    const double noise = column[row] + variance;
    const Vector of_all = by_constant.lazyProduct(weighed.transpose()).template cast<double>();
    const Vector gain = (column - of_all) / (noise + seen.dot(weighed));
    const Matrix taken = gain * column.transpose();
    covariance += noise * gain * gain.transpose() - taken - taken.transpose();
    covariance.diagonal() = covariance.diagonal().cwiseMax(variance * gain.cwiseAbs2());
    by_constant.noalias() += gain.template cast<Scalar>().lazyProduct(seen);
    return gain;
  }

  /// Sets the variance of a variable and removes its correlations.
  void forget(Eigen::Index i, double variance) noexcept {
    covariance.row(i).setZero();
    covariance.col(i).setZero();
    covariance(i, i) = variance;
  }
  /// Replaces the belief about a variable whose mean the owner has set. effect: its derivative by the constants.
  void draw(Eigen::Index i, double variance, const ConstantRow& effect = ConstantRow::Zero()) noexcept {
    forget(i, variance);
    by_constant.row(i) = effect;
  }
  /// Removes the correlations of a variable, so that it and the others do not correct each other.
  void decouple(Eigen::Index i) noexcept { forget(i, covariance(i, i)); }
  /// Multiplies the standard deviations by these factors, variable by variable.
  void widen(const Vector& by) noexcept { covariance = (by.asDiagonal() * covariance * by.asDiagonal()).eval(); }

  /// Returns true if the covariance is finite and its diagonal is not negative.
  bool isSound() const noexcept { return covariance.allFinite() && (covariance.diagonal().array() >= 0.0).all(); }

 private:
  /// P <- P - K c^T. The diagonal is kept at or above that of K R K^T (Joseph's form), below which only rounding can
  /// take it.
  void applyGain(const Vector& gain, const Vector& column, double variance, const ConstantRow& seen) noexcept {
    if constexpr (constants > 0) by_constant.noalias() += gain.template cast<Scalar>().lazyProduct(seen);
    for (Eigen::Index j = 0; j < variables; ++j) {
      covariance(j, j) = std::max(covariance(j, j) - gain[j] * column[j], variance * gain[j] * gain[j]);
      for (Eigen::Index i = j + 1; i < variables; ++i)
        covariance(i, j) = covariance(j, i) = covariance(i, j) - gain[i] * column[j];
    }
  }
};

}  // namespace hammer_loads
