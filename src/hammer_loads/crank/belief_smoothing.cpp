#include "hammer_loads/crank/belief_smoothing.h"

#include <cmath>

#include "hammer_loads/crank/flexible_belief.h"
#include "hammer_loads/estimation/smoothing.h"

namespace hammer_loads {
namespace {

constexpr double kMostAtBlow = 6.0;  // squared distance of five variables: 9 of 10 blows at the dead centre are below 3
// Guard: CrankTrack.ABlowThatIsFarOffEndsAnInterval of kMostAtBlow

constexpr double kWeighing = 0.1, kSmoothedRounding = 1e-6;
// Guard: SmoothedRuns.StampsThatJitterWeighLess of kWeighing
// Numerical: kSmoothedRounding

template <int variables>
using Variables = GaussianBelief<variables, ConstantErrors::kSize>;

/// Beliefs that a step of the model joins, and how.
struct Joined {
  CrankBelief predicted;
  FlexibleMatrix transition{FlexibleMatrix::Identity()};
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
template <int variables>
bool isWidened(const Variables<variables>& predicted, const Variables<variables>& now, double part) noexcept {
  return (now.covariance.diagonal().array() > (1.0 + part) * predicted.covariance.diagonal().array()).any();
}

/// Of the crank alone.
struct OfCrank {
  static constexpr int kVariables = 5;
  static const CrankBelief::Base& of(const CrankBelief& belief) noexcept { return belief; }
  static CrankBelief::Vector change(const CrankBelief& a, const CrankBelief& b) noexcept {
    CrankBelief::Vector change;
    change << difference(a.state.position, b.state.position), a.state.speed - b.state.speed,
        a.state.torque - b.state.torque, std::log(a.state.drive_inertia / b.state.drive_inertia), a.factor - b.factor;
    return change;
  }
  static void move(const CrankBelief::Vector& change, CrankBelief& belief) noexcept { belief.move(change); }
  static void set(const CrankBelief::Base& all, CrankBelief& belief) noexcept {
    static_cast<CrankBelief::Base&>(belief) = all;
  }
};

/// Of the crank and of the motor beyond its coupling.
struct OfCrankAndMotor {
  static constexpr int kVariables = kFlexibleVariables;
  static FlexibleVariables of(const CrankBelief& belief) noexcept { return variablesOf(belief); }
  static FlexibleVariables::Vector change(const CrankBelief& a, const CrankBelief& b) noexcept {
    FlexibleVariables::Vector change;
    change << OfCrank::change(a, b), 0.0, a.state.motor_speed - b.state.motor_speed,
        a.state.log_stiffness - b.state.log_stiffness;
    change[kMotorAngle] = change[CrankBelief::kAngle] + a.state.twist - b.state.twist;
    return change;
  }
  static void move(const FlexibleVariables::Vector& change, CrankBelief& belief) noexcept {
    moveFlexible(change, belief);
  }
  static void set(const FlexibleVariables& all, CrankBelief& belief) noexcept { setVariables(all, belief); }
};

template <class Of>
std::optional<CrankBelief> smoothedOn(const Joined& way, const FilterStep& step, const CrankBelief& before,
                                      const CrankBelief& now, const CrankBelief& next) noexcept {
  constexpr int kSize = Of::kVariables;
  const Variables<kSize>&from = Of::of(before), &predicted = Of::of(way.predicted);
  if (isWidened<kSize>(predicted, Of::of(now), kWeighing)) return std::nullopt;
  const auto change = Of::change(next, way.predicted);
  const auto smoothed = smooth<kSize, ConstantErrors::kSize>(from, way.transition.topLeftCorner<kSize, kSize>(),
                                                             predicted, Of::of(next), change);
  const bool passes = before.state.position.blowsPassed() != now.state.position.blowsPassed();
  if (!smoothed || (passes && !(smoothed->distance < kMostAtBlow))) return std::nullopt;

  CrankBelief result = before;
  Of::move(smoothed->gain * change, result);
  result.boundFactor();
  Of::set(smoothed->belief, result);
  if (!result.isSound(step.most_speed) || isWidened<kSize>(from, smoothed->belief, kSmoothedRounding))
    return std::nullopt;
  return result;
}

}  // namespace

std::optional<CrankBelief> smoothedBelief(ShaftModel model, const FilterStep& step, const CrankBelief& before,
                                          const CrankBelief& now, const CrankBelief& next) noexcept {
  model.setHullMotion(step.hull);
  const std::optional<Joined> way = joined(model, step, before, now);
  if (!way) return std::nullopt;
  return before.motor ? smoothedOn<OfCrankAndMotor>(*way, step, before, now, next)
                      : smoothedOn<OfCrank>(*way, step, before, now, next);
}

void settleBranch(const ShaftModel& model, double factor, CrankBelief& belief) noexcept {
  const bool back = belief.state.position.angle.side == Side::kAfterBlow;
  if (belief.motor) return passBlowFlexible(model, back ? 1.0 / factor : factor, belief.state, nullptr);
  ShaftTransition unused = ShaftTransition::Identity();
  ShaftLoad load;
  passBlow(model, back ? 1.0 / factor : factor, belief.state, load, unused);
}

}  // namespace hammer_loads
