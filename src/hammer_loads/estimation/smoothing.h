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
  using Belief = GaussianBelief<variables, constants>;
  using Matrix = typename Belief::Matrix;
  using Vector = typename Belief::Vector;
  // Scaled to a correlation: variables of different units differ by ten powers of ten.
  const Vector scale = predicted.covariance.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::LDLT<Matrix> factors(scale.asDiagonal() * predicted.covariance * scale.asDiagonal());
  if (factors.info() != Eigen::Success || !(factors.vectorD().array() > 0.0).all()) return std::nullopt;
  const Matrix scaled = scale.asDiagonal() * (transition * before.covariance);
  Smoothed<variables, constants> result;
  result.gain = factors.solve(scaled).transpose() * scale.asDiagonal();
  const Vector scaled_change = scale.asDiagonal() * change;
  result.distance = scaled_change.dot(factors.solve(scaled_change));
  result.belief.by_constant = before.by_constant + result.gain * (next.by_constant - predicted.by_constant);
  const Matrix covariance =
      before.covariance + result.gain * (next.covariance - predicted.covariance) * result.gain.transpose();
  result.belief.covariance = 0.5 * (covariance + covariance.transpose());
  return result;
}

}  // namespace hammer_loads
