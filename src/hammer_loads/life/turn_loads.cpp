#include "hammer_loads/life/turn_loads.h"

namespace hammer_loads::life {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TurnLoads emptyTurn(std::size_t channels) {
  TurnLoads turn;
  for (auto* values : {&turn.minimum, &turn.maximum, &turn.mean}) values->assign(channels, kNone);
  for (auto* instants : {&turn.minimum_instant, &turn.maximum_instant}) instants->assign(channels, 0);
  for (auto* errors : {&turn.of_minimum, &turn.of_maximum}) errors->assign(channels, {});
  turn.skipped.assign(channels, 0);
  return turn;
}

}  // namespace

TurnLoadsRecorder::TurnLoadsRecorder(std::size_t channels)
    : turn_(emptyTurn(channels)), result_(turn_), integrals_(channels) {}

void TurnLoadsRecorder::take(std::int64_t instant, const double* values, const double* deviations, const double* common,
                             bool sampled) noexcept {
  if (!started_) {
    started_ = true;
    turn_.start = instant;
  }
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    const double value = values[i];
    if (!std::isfinite(value)) {
      turn_.skipped[i] += sampled || !std::isnan(value) ? 1U : 0U;
      continue;
    }
    Integral& integral = integrals_[i];
    if (!(value >= turn_.minimum[i])) {
      turn_.minimum[i] = value;
      turn_.minimum_instant[i] = instant;
      turn_.of_minimum[i] = LoadError::at(i, deviations, common);
    }
    if (!(value <= turn_.maximum[i])) {
      turn_.maximum[i] = value;
      turn_.maximum_instant[i] = instant;
      turn_.of_maximum[i] = LoadError::at(i, deviations, common);
    }
    if (!integral.begun) {
      integral = {instant, instant, value, value, 0.0, true};
    } else if (instant > integral.last) {
      const double half = 0.5 * static_cast<double>(instant - integral.last);
      integral.sum += half * integral.last_value + half * value;
      integral.last = instant;
      integral.last_value = value;
    }
  }
}

const TurnLoads& TurnLoadsRecorder::endTurn(std::int64_t instant) noexcept {
  if (!started_) turn_.start = instant;
  turn_.end = instant;
  const auto lasted = [](std::int64_t from, std::int64_t to) {
    return static_cast<double>(std::max<std::int64_t>(to - from, 0));
  };
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    const Integral& integral = integrals_[i];
    if (!integral.begun) continue;
    const double before = lasted(turn_.start, integral.first), after = lasted(integral.last, instant);
    const double time = before + lasted(integral.first, integral.last) + after;
    const double sum = integral.sum + before * integral.first_value + after * integral.last_value;
    turn_.mean[i] = time > 0.0 ? sum / time : integral.last_value;
  }
  std::swap(turn_, result_);
  clear();
  turn_.start = instant;
  turn_.whole = started_ = true;
  return result_;
}

void TurnLoadsRecorder::restart() noexcept {
  clear();
  turn_.whole = started_ = false;
}

void TurnLoadsRecorder::clear() noexcept {
  for (auto* values : {&turn_.minimum, &turn_.maximum, &turn_.mean}) std::fill(values->begin(), values->end(), kNone);
  for (auto* instants : {&turn_.minimum_instant, &turn_.maximum_instant})
    std::fill(instants->begin(), instants->end(), 0);
  for (auto* errors : {&turn_.of_minimum, &turn_.of_maximum}) std::fill(errors->begin(), errors->end(), LoadError{});
  std::fill(turn_.skipped.begin(), turn_.skipped.end(), 0U);
  std::fill(integrals_.begin(), integrals_.end(), Integral{});
}

}  // namespace hammer_loads::life
