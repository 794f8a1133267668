#include "hammer_loads/pipeline/unit_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {
namespace {

constexpr double kDegrees = 360.0 / kTwoPi;  // in a radian
constexpr double kRpm = 60.0 / kTwoPi;       // in a radian a second
constexpr double kTolerance = 1.4;           // factor: counts of a coarse encoder, noise of the speed
constexpr double kLeastStretch = 0.01;       // [rad] of the shorter one: of the speed's noise as well
// Guard: FollowerNumbers.AHundredthOfARadianIsEnoughOfTheOtherUnit of kLeastStretch
constexpr double kStretch = 1.0;       // [rad]: shorter than a turn, so that most stretches see no jump back
constexpr double kLongestStep = 0.25;  // [s]
constexpr double kRepeats = 0.2;       // relative change between steps that repeat each other
// Guard: FollowerNumbers.StepsOfDegreesRepeatThemselves of kRepeats
constexpr double kMoves = 1.0;  // [rad/s]: a slower angle says nothing of its unit
// Guard: FollowerNumbers.AUnitIsRightAgainAfterTwoSecondsOfMotion of kMoves
constexpr int kEnough = 8;  // votes more for another unit than against
// Guard: SensorBounds.OfUnits of kTolerance, kStretch, kLongestStep, kEnough

/// The closest one within the tolerance; ratio: turned over predicted.
CrankUnit unitOf(double ratio) noexcept {
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
    const double off = std::abs(std::log(ratio / known.ratio));  // of a ratio below zero not a number
    if (off < farthest) farthest = off, closest = known.unit;
  }
  return closest;
}

}  // namespace

void UnitCheck::begin(double angle) noexcept {
  last_angle_ = angle;
  last_rate_ = turned_ = predicted_ = 0.0;
}

void UnitCheck::add(double dt, double angle, std::optional<double> speed) noexcept {
  if (!std::isfinite(angle) || !std::isfinite(speed.value_or(0.0))) {
    last_angle_.reset();
    return;
  }
  if (!last_angle_ || !(dt > 0.0) || dt > kLongestStep) return begin(angle);
  const double step = angle - *last_angle_;
  last_angle_ = angle;
  compareWithBound(dt, step / dt);
  if (speed) compareWithSpeed(step, *speed * dt);
  suspected_for_ = suspects() ? suspected_for_ + dt : 0.0;
}

void UnitCheck::compareWithSpeed(double step, double predicted) noexcept {
  turned_ += step;
  predicted_ += predicted;
  // In degrees the one of the two turns much further than the other; counts need some ten to be a ratio.
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
  if (too_fast && std::abs(rate) > kDegrees * max_speed_) return;  // no crank in degrees either
  slow_time_ = too_fast ? 0.0 : slow_time_ + dt;
  if (looksWrong() && !too_fast && slow_time_ < look_back::kTenTurns) return;  // a hammer that stops is slow, too
  vote(bound_votes_, too_fast ? CrankUnit::kDegrees : CrankUnit::kRadians);
}

/// One judge suffices to recognise a unit; both must agree that it is over.
void UnitCheck::vote(int& votes, CrankUnit unit) noexcept {
  const bool wrong = unit != CrankUnit::kRadians;
  votes = std::clamp(votes + (wrong ? 1 : -1), 0, kEnough);
  if (wrong && votes == kEnough && suspected_for_ >= look_back::kTurn) recognised_ = unit;
  if (speed_votes_ == 0 && bound_votes_ == 0) recognised_ = CrankUnit::kRadians;
}

}  // namespace hammer_loads
