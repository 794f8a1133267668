/// Estimate of the constants that a filter considers, from its innovations: weighted least squares, gathered.
#pragma once

#include <Eigen/LU>

#include "hammer_loads/estimation/gates.h"

namespace hammer_loads {

/// An innovation is its derivative by the constants times their error, and noise. Information and score of that add up
/// over the measurements; the oldest fade.
template <int constants>
class ConstantFit {
 public:
  using Row = Eigen::Matrix<double, 1, constants>;
  using Vector = Eigen::Matrix<double, constants, 1>;
  using Matrix = Eigen::Matrix<double, constants, constants>;

  /// Nothing is known but priors: standard deviation of each error, >= 0; 0: it has none, and is not asked.
  void begin(const Vector& prior) noexcept {
    information_ = (prior.array() > 0.0).select(prior.cwiseAbs2().cwiseInverse(), 0.0).matrix().asDiagonal();
    score_.setZero();
  }
  /// The square of an innovation beyond the gate counts as the gate's. by_constant: dz/dp - H V. What it weighs.
  double learn(double innovation, double variance, const Row& by_constant) noexcept {
    const double weight = weightWithin(gate::kRare, innovation, variance) / variance;
    information_.noalias() += (weight * by_constant.transpose()) * by_constant;
    score_ += (weight * innovation) * by_constant.transpose();
    return weight;
  }
  /// One of the given constants has been changed by this much.
  void take(int constant, double change) noexcept { score_ += information_.col(constant) * change; }
  /// Earlier measurements count for this part of themselves.
  void fade(double part) noexcept { information_ *= part, score_ *= part; }

  const Matrix& information() const noexcept { return information_; }
  const Vector& score() const noexcept { return score_; }
  /// Covariance of the first `count` constants, as if the others were exact: together they may hardly be separable.
  template <int count>
  Eigen::Matrix<double, count, count> covarianceOfFirst() const noexcept {
    return information_.template topLeftCorner<count, count>().inverse();
  }

 private:
  Matrix information_{Matrix::Zero()};
  Vector score_{Vector::Zero()};
};

}  // namespace hammer_loads
