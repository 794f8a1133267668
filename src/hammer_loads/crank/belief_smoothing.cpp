#include "hammer_loads/crank/belief_smoothing.h"

#include <cmath>

#include "hammer_loads/estimation/smoothing.h"

namespace hammer_loads {
namespace {

using Vector = CrankBelief::Vector;

constexpr double kMostAtBlow = 6.0;  // squared distance of five variables: 9 of 10 blows at the dead centre are below 3
// Guard: CrankTrack.ABlowThatIsFarOffEndsAnInterval of kMostAtBlow

constexpr double kWeighing = 0.1, kSmoothedRounding = 1e-6;
// Guard: SmoothedRuns.StampsThatJitterWeighLess of kWeighing
// Numerical: kSmoothedRounding

/// Beliefs that a step of the model joins, and how.
struct Joined {
  CrankBelief predicted;
  ShaftMatrix transition{ShaftMatrix::Identity()};
};

/// Predicts to the side of the blow where the filter was afterwards; nothing if the model does not come there.
std::optional<Joined> joined(const ShaftModel& model, const FilterStep& step, const CrankBelief& before,
                             const CrankBelief& now) noexcept {
  const CrankPosition &from = before.state.position, &to = now.state.position;
  const bool passes = from.blowsPassed() != to.blowsPassed();
  const bool contact = passes && !from.isMirrored() && !to.isMirrored();
  Joined result{before};
  CrankBelief& predicted = result.predicted;
  predicted.predict(model, step.walks, step.prior, contact, step.most_speed, step.length, &result.transition);
  CrankPosition& reached = predicted.state.position;
  if (contact && reached.angle.side == Side::kBeforeBlow && to.angle.side == Side::kAfterBlow &&
      reached.blow == to.blow)
    predicted.passLate(model, step.prior, &result.transition);
  if (reached.angle.side != to.angle.side || reached.blow != to.blow) return std::nullopt;
  return result;
}

/// A sample only ever makes a variance smaller, but for a speed that is weighed by constants, which gives up a little
/// for less of theirs; where the filter made one larger by more than this part, the prediction is not what it used.
bool isWidened(const CrankBelief& predicted, const CrankBelief& now, double part) noexcept {
  return (now.covariance.diagonal().array() > (1.0 + part) * predicted.covariance.diagonal().array()).any();
}

Vector between(const CrankBelief& a, const CrankBelief& b) noexcept {
  Vector change;
  change << difference(a.state.position, b.state.position), a.state.speed - b.state.speed,
      a.state.torque - b.state.torque, std::log(a.state.drive_inertia / b.state.drive_inertia), a.factor - b.factor;
  return change;
}

}  // namespace

std::optional<CrankBelief> smoothedBelief(ShaftModel model, const FilterStep& step, const CrankBelief& before,
                                          const CrankBelief& now, const CrankBelief& next) noexcept {
  model.setHullMotion(step.hull);
  const std::optional<Joined> way = joined(model, step, before, now);
  if (!way || isWidened(way->predicted, now, kWeighing)) return std::nullopt;
  const Vector change = between(next, way->predicted);
  const auto smoothed = smooth(before, way->transition, way->predicted, next, change);
  const bool passes = before.state.position.blowsPassed() != now.state.position.blowsPassed();
  if (!smoothed || (passes && !(smoothed->distance < kMostAtBlow))) return std::nullopt;

  CrankBelief result = before;
  result.move(smoothed->gain * change);
  result.boundFactor();
  static_cast<CrankBelief::Base&>(result) = smoothed->belief;
  if (!result.isSound(step.most_speed) || isWidened(before, result, kSmoothedRounding)) return std::nullopt;
  return result;
}

void settleBranch(const ShaftModel& model, double factor, CrankBelief& belief) noexcept {
  const bool back = belief.state.position.angle.side == Side::kAfterBlow;
  ShaftTransition unused = ShaftTransition::Identity();
  ShaftLoad load;
  passBlow(model, back ? 1.0 / factor : factor, belief.state, load, unused);
}

}  // namespace hammer_loads
