/// Gaussian belief about some variables beside constants that are not known exactly: covariance and what the constants
/// do to it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/util/by_constants.h"

namespace hammer_loads {

/// Schmidt's consider filter (Friedland's separate bias): x are `variables` that are corrected; p are the errors of
/// `constants`, which are not. The mean of x is its owner's: it may live on a circle or have bounds. This is what is
/// known about it,
///
///     mean - x = e + V p,  e ~ N(0, P) independent of p,
///
/// P the covariance as if all constants were right, V = d(mean)/dp. Whatever the covariance of p is, and whenever it
/// becomes known, that of the mean's error is P + V cov(p) V^T: grown(). An innovation is (dz/dp - H V) p and noise;
/// ConstantFit gathers what that says of p.
///
/// Fixed sizes, no allocation, nothing throws. P stays symmetric to the last bit.
template <int variables, int constants>
struct GaussianBelief {
  using Vector = Eigen::Matrix<double, variables, 1>;
  using Row = Eigen::Matrix<double, 1, variables>;  ///< derivative of a number by the variables
  using Matrix = Eigen::Matrix<double, variables, variables>;
  using Effect = ByConstants<variables, constants>;
  using ConstantRow = Eigen::Matrix<double, 1, constants>;  ///< derivative of a number by the constants
  using ConstantMatrix = Eigen::Matrix<double, constants, constants>;

  Matrix covariance{Matrix::Zero()};   ///< P
  Effect by_constant{Effect::Zero()};  ///< V

  /// By a transition F = d(after)/d(before) that is the identity but for some rows; f: those, in the order of `rows`.
  /// P <- F P F^T, V <- F V.
  template <Eigen::Index... rows>
  void predict(const Eigen::Matrix<double, int{sizeof...(rows)}, variables>& f) noexcept {
    constexpr Eigen::Index changed[] = {rows...};
    constexpr int count = sizeof...(rows);
    const Eigen::Matrix<double, count, variables> moved = f * covariance;
    const Eigen::Matrix<double, count, count> both = moved * f.transpose();
    const ByConstants<count, constants> effect = f * by_constant;
    for (int i = 0; i < count; ++i) {
      covariance.row(changed[i]) = moved.row(i);
      covariance.col(changed[i]) = moved.row(i).transpose();
      by_constant.row(changed[i]) = effect.row(i);
    }
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k <= i; ++k) covariance(changed[i], changed[k]) = covariance(changed[k], changed[i]) = both(i, k);
    }
  }
  /// Covariance of two variables, or variance of one, grows by a noise that is independent of everything.
  void addNoise(Eigen::Index i, Eigen::Index k, double value) noexcept {
    covariance(i, k) += value;
    if (i != k) covariance(k, i) = covariance(i, k);
  }

  /// Takes a measurement of one variable with noise of a variance >= 0. measured_by_constant: what the constants make
  /// of the reading itself. The gain: the owner moves its mean by that times the innovation.
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
    applyGain(gain, column, variance, measured_by_constant - seen * by_constant);
    return gain;
  }
  /// Corrects by a measurement of one variable where the constants have these variances, independent of each other. The
  /// gain is Schmidt's: the least total error if they are not corrected. 0, or none at all: as if the constant were
  /// right.
  Vector correct(Eigen::Index row, double variance, const ConstantRow& measured_by_constant,
                 const std::optional<ConstantRow>& of_constants) noexcept {
    if (!of_constants) return correct(row, variance, measured_by_constant);
    const ConstantRow seen = measured_by_constant - by_constant.row(row), weighed = seen.cwiseProduct(*of_constants);
    const Vector column = covariance.col(row);
    const double noise = column[row] + variance;
    const Vector gain = (column - by_constant * weighed.transpose()) / (noise + seen.dot(weighed));
    const Matrix taken = gain * column.transpose();
    covariance += noise * gain * gain.transpose() - taken - taken.transpose();
    covariance.diagonal() = covariance.diagonal().cwiseMax(variance * gain.cwiseAbs2());
    by_constant.noalias() += gain.lazyProduct(seen);
    return gain;
  }

  /// A variable's mean is worth this variance now, whatever the others are.
  void forget(Eigen::Index i, double variance) noexcept {
    covariance.row(i).setZero();
    covariance.col(i).setZero();
    covariance(i, i) = variance;
  }
  /// Replaces a mean that the owner has drawn; effect: of the constants on it.
  void draw(Eigen::Index i, double variance, const ConstantRow& effect = ConstantRow::Zero()) noexcept {
    forget(i, variance);
    by_constant.row(i) = effect;
  }
  /// The belief about a variable stays; coming measurements of the others teach nothing of it, nor the other way round.
  void decouple(Eigen::Index i) noexcept { forget(i, covariance(i, i)); }
  /// Deviations are this much larger, variable by variable.
  void widen(const Vector& by) noexcept { covariance = (by.asDiagonal() * covariance * by.asDiagonal()).eval(); }

  /// Covariance of the variables where that of the constants is as given; growth: what noise is to be multiplied with.
  Matrix grown(double growth, const ConstantMatrix& of_constants) const noexcept {
    return growth * covariance + (by_constant * of_constants) * by_constant.transpose();
  }
  /// Neither infinite nor negative.
  bool isSound() const noexcept { return covariance.allFinite() && (covariance.diagonal().array() >= 0.0).all(); }

 private:
  /// P <- P - K c^T. The corrected covariance is never below K R K^T (Joseph's form): a diagonal that rounding takes
  /// below that is worth nothing.
  void applyGain(const Vector& gain, const Vector& column, double variance, const ConstantRow& seen) noexcept {
    if constexpr (constants > 0) by_constant.noalias() += gain.lazyProduct(seen);  // Eigen 3.3 has no such product
    for (Eigen::Index j = 0; j < variables; ++j) {
      covariance(j, j) = std::max(covariance(j, j) - gain[j] * column[j], variance * gain[j] * gain[j]);
      for (Eigen::Index i = j + 1; i < variables; ++i)
        covariance(i, j) = covariance(j, i) = covariance(i, j) - gain[i] * column[j];
    }
  }
};

}  // namespace hammer_loads
