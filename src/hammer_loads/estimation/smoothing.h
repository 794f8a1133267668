/// The way back over one step: what later measurements say of an earlier belief.
#pragma once

#include <Eigen/Cholesky>
#include <optional>

#include "hammer_loads/estimation/gaussian_belief.h"

namespace hammer_loads {

/// The link of a belief to the one a step later.
template <int variables, int constants>
struct Smoothed {
  using Belief = GaussianBelief<variables, constants>;

  Belief belief;                 ///< by all measurements
  typename Belief::Matrix gain;  ///< the mean moves by that times (later mean, smoothed, less predicted one)
  double distance{};             ///< squared, of the later mean from the predicted one, in predicted deviations
};

/// Rauch, Tung and Striebel's step with constants that are considered. before: by the measurements up to it;
/// transition: d(predicted)/d(before); predicted: what a step makes of `before`; next: the later belief by all
/// measurements; change: its mean less the predicted one. Nothing where the predicted covariance is singular.
template <int variables, int constants>
std::optional<Smoothed<variables, constants>> smooth(
    const GaussianBelief<variables, constants>& before,
    const typename GaussianBelief<variables, constants>::Matrix& transition,
    const GaussianBelief<variables, constants>& predicted, const GaussianBelief<variables, constants>& next,
    const typename GaussianBelief<variables, constants>::Vector& change) noexcept {
  using Matrix = typename GaussianBelief<variables, constants>::Matrix;
  using Vector = typename GaussianBelief<variables, constants>::Vector;
  // Of any size: one solver for all beliefs, which each would build for itself.
  using Any = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 8, 8>;
  static_assert(variables <= Any::MaxRowsAtCompileTime);
  // Scaled to a correlation: variables of different units differ by ten powers of ten.
  const Vector scale = predicted.covariance.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Any correlation = scale.asDiagonal() * predicted.covariance * scale.asDiagonal();
  const Eigen::LDLT<Any> factors(correlation);
  if (factors.info() != Eigen::Success || !(factors.vectorD().array() > 0.0).all()) return std::nullopt;
  const Any scaled = scale.asDiagonal() * (transition * before.covariance), solved = factors.solve(scaled);
  Smoothed<variables, constants> result;
  result.gain = solved.transpose() * scale.asDiagonal();
  const Any scaled_change = scale.asDiagonal() * change, solved_change = factors.solve(scaled_change);
  result.distance = scaled_change.cwiseProduct(solved_change).sum();
  result.belief.by_constant = before.by_constant + result.gain * (next.by_constant - predicted.by_constant);
  const Matrix covariance =
      before.covariance + result.gain * (next.covariance - predicted.covariance) * result.gain.transpose();
  result.belief.covariance = 0.5 * (covariance + covariance.transpose());
  return result;
}

}  // namespace hammer_loads
