#include "hammer_loads/crank/contact_hypothesis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/crank/consistency.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kDecided = 12.0;  // logarithm of odds to suspend the less likely belief; also their bound
constexpr double kChange = 9.0;    // logarithm of odds at which the other belief becomes the estimate
constexpr double kMostFit = 8.0;   // largest contribution of one sample, which may be an outlier

}  // namespace

void ContactHypothesis::begin(const CrankBelief& belief) noexcept {
  belief_ = belief;
  evidence_ = std::log(turns_without_ / turns_with_);
  aside_ = false;
}

void ContactHypothesis::beginAnew(const CrankBelief& estimate) noexcept {
  begin(estimate);
  Side& side = belief_->state.position.angle.side;
  side = opposite(side);
}

void ContactHypothesis::follow(const WeighedSample& sample, const ShaftModel& model, double fit, double growth,
                               double most_speed) noexcept {
  CrankBelief& belief = *belief_;
  const Innovation angle = sample.ofAngle(belief);
  double own_fit = angle.logLikelihood();
  const double jolt = square(angle.value / gate::kImpossible);
  belief.correct(CrankBelief::kAngle, angle.value, std::max(angle.variance, jolt), angle.by_error);
  if (sample.speed) {
    const Innovation speed = sample.ofSpeed(belief, model);
    own_fit += speed.logLikelihood();
    if (!speed.exceeds(gate::kImpossible))
      belief.correct(CrankBelief::kSpeed, speed.value, speed.variance, speed.by_error, sample.of_speed);
  }
  evidence_ = std::max(-kDecided, evidence_ + std::clamp(own_fit - fit, -kMostFit, kMostFit) / growth);
  if (!belief.isSound(most_speed)) drop();
}

bool ContactHypothesis::choose(CrankBelief& estimate, bool& mirrored) noexcept {
  aside_ = aside_ || evidence_ == -kDecided;
  if (aside_ && !mirrored && std::abs(estimate.state.position.angle.offset) < RodEvidence::kPickedUp) return false;
  const bool change = evidence_ > kChange;
  if (change) {
    std::swap(estimate, *belief_);
    evidence_ = -kChange;
    aside_ = false;
    mirrored = !mirrored;
  }
  if (evidence_ > -kDecided) return change;
  (mirrored ? turns_without_ : turns_with_) += 1.0;
  drop();
  return change;
}

}  // namespace hammer_loads
