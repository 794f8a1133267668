#include "hammer_loads/pipeline/crank_checks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/hammer/hull_model.h"

namespace hammer_loads {
namespace {

constexpr double kLargestAngle = 1e9;  // [rad]: beyond it a double resolves less than an encoder count
// Limit: kLargestAngle

constexpr double kDegrees = 360.0 / kTwoPi;  // in a radian
constexpr double kRpm = 60.0 / kTwoPi;       // in a radian a second
constexpr double kTolerance = 1.4;           // factor: counts of a coarse encoder, noise of the speed
constexpr double kLeastStretch = 0.01;  // [rad] for the shorter stretch: limits the effect of the speed's noise as well
constexpr double kStretch = 1.0;        // [rad]: shorter than a revolution, so that most stretches contain no jump back
constexpr double kLongestStep = 0.25;   // [s]
constexpr double kRepeats = 0.2;        // relative change between steps that repeat each other
constexpr double kMoves = 1.0;          // [rad/s]: a slower angle does not show its unit
constexpr int kEnough = 8;              // surplus of votes for another unit

constexpr double kWindow = 8e-3;                    // [s] over which a rate is taken
constexpr double kMeanRate = 1.0;                   // time constant of the mean rate [s]
constexpr double kSlowPart = 0.8, kFastPart = 1.2;  // of the mean rate: a crank at work passes both in each revolution
constexpr double kLikeRevolution = 1.25;            // factor
constexpr double kSameLength = 0.2;                 // relative change from one revolution to the next
constexpr double kLeastCounts = 100.0;              // counts per revolution
// Limit: kTolerance, kLeastStretch, kStretch, kLongestStep, kRepeats, kMoves, kEnough, kWindow, kMeanRate, kSlowPart,
// kFastPart, kLikeRevolution, kSameLength, kLeastCounts

/// Returns the unit that matches the length of a cycle, in the angle's own unit times the gain; empty if none does.
std::optional<CrankUnit> unitOfRevolution(double length) noexcept {
  const auto is = [&](double other) { return std::abs(std::log(length / other)) < std::log(kLikeRevolution); };
  if (is(kTwoPi)) return CrankUnit::kRadians;
  if (is(1.0)) return CrankUnit::kAngleInTurns;
  if (is(360.0)) return CrankUnit::kDegrees;
  return length > kLeastCounts ? std::make_optional(CrankUnit::kAngleInCounts) : std::nullopt;
}

/// Returns the closest unit within the tolerance. ratio: measured over predicted rotation.
CrankUnit unitOf(double ratio) noexcept {
  if (std::abs(std::log(-ratio)) < std::log(kTolerance)) return CrankUnit::kSpeedSign;
  constexpr struct {
    double ratio;
    CrankUnit unit;
  } kUnits[] = {{kDegrees, CrankUnit::kDegrees},
                {1.0 / kDegrees, CrankUnit::kDegrees},
                {1.0 / kRpm, CrankUnit::kSpeedInRpm},
                {1.0 / kTwoPi, CrankUnit::kAngleInTurns},
                {kTwoPi, CrankUnit::kSpeedInTurns}};
  CrankUnit closest = CrankUnit::kRadians;
  double farthest = std::log(kTolerance);
  for (const auto& known : kUnits) {
    const double off = std::abs(std::log(ratio / known.ratio));  // not a number for a ratio below zero
    if (off < farthest) farthest = off, closest = known.unit;
  }
  return closest;
}

}  // namespace

std::optional<Refusal> CrankSampleGate::refusalOf(const CrankSample& sample) const noexcept {
  const double speed = sample.speed.value_or(0.0);
  if (!std::isfinite(sample.angle) || !std::isfinite(speed)) return Refusal::kNotFinite;
  if (std::abs(sample.angle) > kLargestAngle || std::abs(speed) > limits_.max_speed) return Refusal::kImplausible;
  return std::nullopt;
}

CrankSampleGate::Verdict CrankSampleGate::judge(StampNs stamp, const CrankSample& sample) noexcept {
  if (stamp < 0 || stamp > kLastStamp) return {Refusal::kBadStamp};
  if (const std::optional<Refusal> refusal = refusalOf(sample)) return {refusal};
  const auto [place, step] = stamps_.judge(stamp);
  switch (place) {
    case StampOrder::Place::kDuplicate:
      return {Refusal::kDuplicate};
    case StampOrder::Place::kOutOfOrder:
      return {Refusal::kOutOfOrder};
    case StampOrder::Place::kFirst:
    case StampOrder::Place::kNext:
      break;
  }
  if (isFrozen(step, sample)) return {Refusal::kImplausible};
  return {std::nullopt, place == StampOrder::Place::kFirst ? Order::kFirst : Order::kNext, step, isSpeedDead(sample)};
}

/// Returns true if the angle is frozen, which may happen while the speed changes.
bool CrankSampleGate::isFrozen(double step, const CrankSample& sample) noexcept {
  const double speed = std::abs(sample.speed.value_or(0.0)), turn = speed * step;
  const bool turns = speed > limits_.frozen_speed && (frozen_ || (turn > limits_.frozen_turn && turn < 0.5 * kTwoPi));
  // Compares all bits, since counts repeat exactly and the noise of any working sensor changes some bits.
  frozen_ = turns && sample.angle == accepted_.angle;
  return frozen_;
}

bool CrankSampleGate::isSpeedDead(const CrankSample& sample) const noexcept {
  return sample.speed == 0.0 && accepted_.speed == 0.0 &&
         std::abs(CrankAngle::wrapToPi(sample.angle - accepted_.angle)) > limits_.frozen_turn;
}

void UnitCheck::begin(double angle) noexcept {
  last_angle_ = angle;
  last_rate_ = turned_ = predicted_ = last_step_ = 0.0;
  cycle_ = {};
}

void UnitCheck::add(double dt, double angle, std::optional<double> speed) noexcept {
  if (!std::isfinite(angle) || !std::isfinite(speed.value_or(0.0))) {
    last_angle_.reset();
    return;
  }
  if (!last_angle_ || !(dt > 0.0) || dt > kLongestStep) return begin(angle);
  const double step = angle - *last_angle_;
  constexpr double kBack = 3.0;  // times the step before: the angle is wrapped there
  // Limit: kBack
  const bool wraps = step * last_step_ < 0.0 && std::abs(step) > kBack * std::abs(last_step_);
  const bool was_still = last_step_ == 0.0 && step != 0.0;
  if (!wraps) last_step_ = step;
  followCycle(dt, last_step_);
  if (was_still) turned_ = predicted_ = 0.0;  // the first step of an angle that stood still may hold a revolution
  last_angle_ = angle;
  compareWithBound(dt, step / dt);
  if (speed && !was_still) compareWithSpeed(last_step_, *speed * dt);
  suspected_for_ = suspects() ? suspected_for_ + dt : 0.0;
}

void UnitCheck::compareWithSpeed(double step, double predicted) noexcept {
  turned_ += step;
  predicted_ += predicted;
  // If one of the two is in degrees, it advances much further than the other. A ratio needs some ten encoder counts.
  if (std::abs(predicted_) < kStretch && (std::abs(turned_) < kStretch || std::abs(predicted_) < kLeastStretch)) return;
  const CrankUnit unit = unitOf(turned_ / predicted_);
  // An angle that stands still and then catches up looks like one unit and then like another.
  if (unit != CrankUnit::kRadians && std::exchange(speed_unit_, unit) != unit) speed_votes_ = 0;
  vote(speed_votes_, unit);
  turned_ = predicted_ = 0.0;
}

void UnitCheck::compareWithBound(double dt, double rate) noexcept {
  const bool repeats = std::abs(rate - last_rate_) < kRepeats * std::abs(rate);
  last_rate_ = rate;
  if (!repeats || std::abs(rate) < kMoves) return;
  const bool too_fast = std::abs(rate) > max_speed_;
  if (too_fast && std::abs(rate) > kDegrees * max_speed_) return;  // too fast for any crank, even in degrees
  slow_time_ = too_fast ? 0.0 : slow_time_ + dt;
  if (isOtherUnit() && !too_fast && slow_time_ < look_back::kTenTurns) return;  // a hammer that stops is slow, too
  vote(bound_votes_, too_fast ? CrankUnit::kDegrees : CrankUnit::kRadians);
}

void UnitCheck::followCycle(double dt, double turned) noexcept {
  auto& c = cycle_;
  c.turned += turned;
  c.time += dt;
  if (c.time < kWindow) return;
  const double rate = std::abs(c.turned) / c.time;
  c.length += std::abs(c.turned);
  c.mean += std::min(1.0, c.time / kMeanRate) * (rate - c.mean);
  c.turned = c.time = 0.0;
  c.slow = c.slow || rate < kSlowPart * c.mean;
  if (!c.slow || rate < kFastPart * c.mean) return;
  c.slow = false;
  const double length = std::exchange(c.length, 0.0), before = std::exchange(c.before, length);
  const std::optional<CrankUnit> unit = unitOfRevolution(gain_ * length);
  if (!unit || std::abs(length - before) > kSameLength * length) return;
  if (*unit != CrankUnit::kRadians && std::exchange(cycle_unit_, *unit) != *unit) cycle_votes_ = 0;
  vote(cycle_votes_, *unit);
}

/// Counts a vote. One criterion suffices to recognise another unit; all must agree to return to radians.
void UnitCheck::vote(int& votes, CrankUnit unit) noexcept {
  const bool wrong = unit != CrankUnit::kRadians;
  votes = std::clamp(votes + (wrong ? 1 : -1), 0, kEnough);
  if (wrong && votes == kEnough && suspected_for_ >= look_back::kTurn) recognised_ = unit;
  // A rate too fast for radians may be counts as well: the length of a revolution decides.
  if (recognised_ == CrankUnit::kDegrees && cycle_votes_ == kEnough && cycle_unit_ == CrankUnit::kAngleInCounts)
    recognised_ = CrankUnit::kAngleInCounts;
  if (speed_votes_ == 0 && bound_votes_ == 0 && cycle_votes_ == 0) recognised_ = CrankUnit::kRadians;
}

}  // namespace hammer_loads
