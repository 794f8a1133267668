// What the filter learns of the machine: once a turn, from each innovation, and what it forgets again.
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/flexible_belief.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kUnlearnEvery = 3.0;  // [s]
// Guard: FilterAtWork.IsUnexplainedAfterThreeTimesThreeSeconds of kUnlearnEvery

}  // namespace

/// (10) Once a turn, half a turn after the blow: by then all samples that show it have come.
void CrankFilter::rememberBlow(const CrankBelief& last, double dt) noexcept {
  supply_.pass(dt);
  const CrankPosition &from = last.state.position, &to = now_.state.position;
  if (from.angle.side != Side::kAfterBlow || to.angle.side != Side::kBeforeBlow || to.blow != from.blow + 1) return;
  const bool had_contact = !from.isMirrored() && !to.isMirrored();
  supply_.endTurn(to, had_contact);
  speed_trust_.endTurn();
  slip_.endTurn();
  if (!had_contact) return;
  considerSensor();
  errors_.endTurn(consistency_.growth(), encoder_.resolution());
  learnSupply();
  blows_.add(now_.factor, now_.covariance(Belief::kFactor, Belief::kFactor), now_.by_constant.row(Belief::kFactor));
}

/// (10) Other than the sensor's errors, that of the supply's stiffness is corrected.
void CrankFilter::learnSupply() noexcept {
  const double change = supply_.learn(errors_.estimate()[ConstantErrors::kSupply]);
  now_.move(now_.by_constant.col(ConstantErrors::kSupply) * change);
  errors_.takeSupply(change);
}

/// (10) ratio: of the innovation before a tool or a slip was taken up.
void CrankFilter::learnFrom(const Innovation& innovation, double ratio) noexcept {
  if (std::abs(now_.state.speed) <= kLearnSpeed) return;
  consistency_.add(ratio);
  rod_evidence_.add(now_.state.position.angle, ratio);
  if (now_.state.position.angle.side == Side::kBeforeBlow)
    strike_consistency_.add(ratio);
  else
    strike_consistency_.endHalfTurn();
  const double jitter = square(now_.state.speed) * timing_.variance();
  roughness_.learn(innovation.value, innovation.total, jitter / innovation.total);
  errors_.learn(innovation.value, innovation.total, innovation.by_error - now_.encoderByError(Belief::kAngle));
}

/// (10) A machine that is not explained for seconds may have been learned wrong while the stamps' jitter was not known.
void CrankFilter::doubtInertia(double dt) noexcept {
  unlearn_after_ -= dt;
  if (!(consistency_.growth() > mismatch::kUnexplained) || unlearn_after_ > 0.0) return;
  unlearn_after_ = kUnlearnEvery;
  doubt_load_ += 1.0;
  forgetInertia();
}

/// (10) What was learned of the machine was of other readings.
void CrankFilter::forgetInertia() noexcept {
  now_.state.drive_inertia = first_guess_;
  now_.by_constant.row(Belief::kInertia).setZero();
  now_.forgetInertiaCoupling();
  now_.covariance(Belief::kInertia, Belief::kInertia) = square(settings_.initial_inertia_deviation);
  now_.covariance(Belief::kTorque, Belief::kTorque) += square(settings_.initial_torque_deviation);
  if (now_.motor) doubtStiffness(*model_.coupling(), now_);
  consistency_.restart();
}

}  // namespace hammer_loads
