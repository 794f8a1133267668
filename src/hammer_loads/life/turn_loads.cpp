#include "hammer_loads/life/turn_loads.h"

namespace hammer_loads::life {

TurnLoadsRecorder::TurnLoadsRecorder(std::size_t channels) : integrals_(channels) {
  turn_.channels.resize(channels);
  result_ = turn_;
}

void TurnLoadsRecorder::add(std::int64_t instant, const double* values, const double* deviations,
                            const double* common) noexcept {
  if (!started_) {
    started_ = true;
    turn_.start = instant;
  }
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    const double value = values[i];
    if (!std::isfinite(value)) continue;
    ChannelTurn& channel = turn_.channels[i];
    Integral& integral = integrals_[i];
    const auto reached = [&] { return LoadExtreme{value, instant, LoadError::at(i, deviations, common)}; };
    if (!(value >= channel.minimum.value)) channel.minimum = reached();
    if (!(value <= channel.maximum.value)) channel.maximum = reached();
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
    turn_.channels[i].mean = time > 0.0 ? sum / time : integral.last_value;
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
  std::fill(turn_.channels.begin(), turn_.channels.end(), ChannelTurn{});
  std::fill(integrals_.begin(), integrals_.end(), Integral{});
}

}  // namespace hammer_loads::life
