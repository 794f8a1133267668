/// The estimate between two samples.
#pragma once

#include <optional>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/crank/crank_estimate.h"

namespace hammer_loads {

/// Estimate of a state at which the model has the load.
inline CrankEstimate estimateOf(const ShaftLoad& load, const ShaftState& state) noexcept {
  return {state.position, state.speed, acceleration(load, state)};
}

/// Two samples and the step between them; refers to its arguments.
struct BetweenSamples {
  const ShaftModel& model;
  const ShaftModel& step_model;  ///< with the hull's mean motion over the step
  const CrankBelief& before;
  const CrankBelief& now;
  const HullMotion& before_hull;  ///< at the samples
  const HullMotion& now_hull;
  double step{};        ///< [s]
  double most_speed{};  ///< from which on an estimate has diverged [rad/s]
};

/// Weighted mean of the prediction forward from the earlier sample and backward from the later one, each with more
/// weight near its own end. A prediction that diverges, between impossible samples, is left out. dt after the earlier
/// one, less than the step [s].
CrankEstimate estimateBetween(const BetweenSamples& samples, double dt) noexcept;

/// Crank by both paths, each with its own speed and torque, at the place between them. None where one has diverged.
std::optional<CrankWays> waysBetween(const BetweenSamples& samples, double dt) noexcept;

}  // namespace hammer_loads
