#include "hammer_loads/life/life_recorder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hammer_loads::life {

std::int64_t dayOf(std::int64_t stamp) noexcept {
  constexpr std::int64_t kDay = 86400LL * 1000 * 1000 * 1000;
  return stamp / kDay - (stamp % kDay < 0 ? 1 : 0);
}

void LifePiece::advance(const LifePiece& since) {
  stamp = since.stamp;
  duration += since.duration;
  turns += since.turns;
  messages += since.messages;
  marks.insert(marks.end(), since.marks.begin(), since.marks.end());
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i].advance(since.counts[i]);
}

LifeRecorder::LifeRecorder(const LifeSettings& settings, const std::vector<std::string>& inputs)
    : period_(settings.period) {
  const auto termOf = [&](const Influence& influence) {
    const auto found = std::find(inputs.begin(), inputs.end(), influence.channel);
    if (found == inputs.end()) throw std::invalid_argument(influence.channel + ": is no channel of this machine");
    return Term{static_cast<std::size_t>(found - inputs.begin()), influence.factor};
  };
  for (const CountedChannel& channel : settings.channels) {
    names_.push_back(countedName(channel.name, settings.bandwidth));
    Counted counted{CycleCounter(channel.grid), {}};
    for (const Influence& influence : channel.influences) counted.terms.push_back(termOf(influence));
    if (channel.influences.empty()) counted.terms.push_back(termOf({channel.name, 1.0}));
    counted_.push_back(std::move(counted));
  }
}

double LifeRecorder::Counted::valueOf(const double* values) const noexcept {
  double value = 0.0;
  for (const Term& term : terms) value += term.factor * values[term.input];
  return value;
}

/// Errors of samples are independent between the loads of one instant; the sizes of errors by constants add at most.
LoadError LifeRecorder::Counted::errorOf(const double* deviations, const double* common) const noexcept {
  double variance = 0.0, alike = 0.0;
  for (const Term& term : terms) {
    const LoadError error = LoadError::at(term.input, deviations, common);
    variance += term.factor * term.factor * error.own * error.own;
    alike += std::abs(term.factor) * error.common;
  }
  return {std::sqrt(variance), alike};
}

void LifeRecorder::sample(std::int64_t stamp, const double* values, const double* deviations,
                          const double* common) noexcept {
  for (Counted& counted : counted_) {
    const double value = counted.valueOf(values);
    counted.counter.add(value);
    if (!CycleCounter::isLoad(value)) continue;
    const LoadError error = counted.errorOf(deviations, common);
    counted.counter.addDeviation(error.deviation());
    counted.extremes.add(value, error);
  }
  lastUntil(stamp);
  if (!piece_begun_) {
    piece_begun_ = true;
    piece_start_ = stamp;
  }
}

void LifeRecorder::between(std::int64_t instant, const double* values, const double* deviations,
                           const double* common) noexcept {
  for (Counted& counted : counted_) {
    const double value = counted.valueOf(values);
    if (std::isnan(value)) continue;
    counted.counter.add(value);
    if (CycleCounter::isLoad(value)) counted.extremes.add(value, counted.errorOf(deviations, common));
  }
  lastUntil(instant);
}

void LifeRecorder::lastUntil(std::int64_t stamp) noexcept {
  if (contiguous_ && stamp > last_) duration_ += static_cast<std::uint64_t>(stamp - last_);
  contiguous_ = true;
  last_ = stamp;
}

void LifeRecorder::turn() noexcept {
  ++turns_;
  for (Counted& counted : counted_) {
    const LoadError error = counted.extremes.ofRange();
    counted.counter.addRange(counted.extremes.range(), error.own, error.common);
    counted.extremes = {};
  }
}

void LifeRecorder::gap() noexcept {
  if (!contiguous_) return;  // before the first sample, or of one gap twice
  contiguous_ = false;
  for (Counted& counted : counted_) counted.counter.gap();
}

bool LifeRecorder::due(std::int64_t stamp) const noexcept {
  if (!piece_begun_) return false;
  return stamp < piece_start_ || stamp - piece_start_ >= period_ || dayOf(stamp) != dayOf(piece_start_);
}

LifePiece LifeRecorder::take() {
  LifePiece piece;
  piece.stamp = last_;
  piece.duration = std::exchange(duration_, 0);
  piece.turns = std::exchange(turns_, 0);
  for (Counted& counted : counted_) piece.counts.push_back(counted.counter.take());
  piece_begun_ = false;
  return piece;
}

}  // namespace hammer_loads::life
