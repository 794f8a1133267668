#include "hammer_loads/pipeline/crank_step.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"

namespace hammer_loads {
namespace {

constexpr double kBlowSpeed = kCreeping;  // crank speed below which it creeps over the blow and nothing strikes

bool isEarlier(const CrankStep::Passage& passage, Side side) noexcept {
  return (side == Side::kBeforeBlow) == passage.forward;
}

}  // namespace

void CrankStep::forget(const CrankPosition& at) noexcept {
  known_ = false;
  passages_ = 0;
  furthest_blow_ = at.blowsPassed();
  links_ = links_before_ = hammer_loads::linksAt(*model_, at.angle);
}

void CrankStep::take(StampNs start, double length, const CrankPosition& from) noexcept {
  known_ = true;
  start_ = start;
  length_ = length;
  passages_ = 0;
  const CrankPosition now = tracker_->estimate().position;
  links_before_ = links_;
  links_ = hammer_loads::linksAt(*model_, now.angle);
  std::int64_t passed = from.blowsPassed();
  const std::int64_t passed_now = now.blowsPassed();
  for (; passed != passed_now && passages_ < passage_.size(); ++passages_) {
    const bool forward = passed < passed_now;
    const std::int64_t blow = forward ? ++passed : passed--;
    passage_[passages_] = passageOf(blow, forward);
    furthest_blow_ = std::max(furthest_blow_, passed);
  }
}

CrankStep::Passage CrankStep::passageOf(std::int64_t blow, bool forward) const noexcept {
  Passage p;
  p.time = timeOfBlow(blow);
  p.blow = blow;
  p.forward = forward;
  const CrankEstimate before = at(std::max(0.0, p.time - kBesideBlow)),
                      after = at(std::min(length_, p.time + kBesideBlow));
  p.smooth = before.position.isMirrored() || after.position.isMirrored();
  p.speed_before = before.speed;
  p.speed_after = after.speed;
  p.may_strike = forward && !before.position.isMirrored() && blow > furthest_blow_ && p.speed_before >= kBlowSpeed;
  p.strikes = p.may_strike && !p.smooth;
  return p;
}

/// Root of the position by bracketing false position (Illinois).
double CrankStep::timeOfBlow(std::int64_t blow) const noexcept {
  const CrankPosition at_blow{blow, {0.0, Side::kAfterBlow}};
  double low = 0.0, high = length_;
  double f_low = difference(at(low).position, at_blow), f_high = difference(at(high).position, at_blow);
  const double sign = f_high < f_low ? -1.0 : 1.0;  // a crank that turns back
  f_low *= sign, f_high *= sign;
  constexpr double kAngleTolerance = 1e-11;  // [rad]: some 1e-12 s
  // Numerical: kAngleTolerance
  int kept = 0;  // end that stayed last time: +1 high, -1 low
  for (int i = 0; i < 60 && f_high > kAngleTolerance && f_low < -kAngleTolerance; ++i) {
    const double time = (low * f_high - high * f_low) / (f_high - f_low);
    const double f = sign * difference(at(time).position, at_blow);
    if (f < 0.0) {
      low = time, f_low = f;
      if (kept == 1) f_high *= 0.5;
      kept = 1;
    } else {
      high = time, f_high = f;
      if (kept == -1) f_low *= 0.5;
      kept = -1;
    }
  }
  return f_high <= -f_low ? high : low;
}

double CrankStep::timeBesides(const Passage& passage, Side side) const noexcept {
  return isEarlier(passage, side) ? std::max(0.0, passage.time - kBesideBlow) : passage.time + kBesideBlow;
}

CrankEstimate CrankStep::besides(const Passage& passage, Side side) const noexcept {
  CrankEstimate estimate = at(timeBesides(passage, side));
  estimate.position = {passage.blow, {0.0, side}};
  estimate.speed = isEarlier(passage, side) ? passage.speed_before : passage.speed_after;
  return estimate;
}

double CrankStep::timeDeviation(const Passage& passage) const noexcept {
  const CrankUncertainty there = tracker_->uncertaintyBetween(timeBesides(passage, Side::kBeforeBlow), 1.0);
  return std::sqrt(there.covariance()(CrankUncertainty::kAngle, CrankUncertainty::kAngle)) /
         std::abs(passage.speed_before);
}

std::optional<CrankWays> CrankStep::waysBesides(const Passage& passage, Side side) const noexcept {
  std::optional<CrankWays> ways = tracker_->waysBetween(timeBesides(passage, side));
  if (ways) ways->forward.position = ways->back.position = {passage.blow, {0.0, side}};
  return ways;
}

}  // namespace hammer_loads
