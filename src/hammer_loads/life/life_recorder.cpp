#include "hammer_loads/life/life_recorder.h"

#include <algorithm>
#include <cmath>
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

Checked<LifeRecorder> LifeRecorder::make(const LifeSettings& settings, const std::vector<std::string>& inputs) {
  Checked<LifeRecorder> result;
  LifeRecorder recorder;
  recorder.period_ = settings.period;
  const auto addTerm = [&](const std::string& channel, double factor) {
    const auto found = std::find(inputs.begin(), inputs.end(), channel);
    if (found == inputs.end()) {
      result.problems.push_back(channel + ": is no channel of this machine");
    } else {
      recorder.terms_.push_back({static_cast<std::size_t>(found - inputs.begin()), factor});
    }
  };
  const auto addCounter = [&](const std::string& name, const LoadGrid& grid, std::size_t first_term) {
    recorder.names_.push_back(countedName(name, settings.bandwidth));
    recorder.counters_.emplace_back(grid);
    recorder.sums_.push_back({first_term, recorder.terms_.size()});
  };
  for (const CountedChannel& channel : settings.channels) {
    const std::size_t first = recorder.terms_.size();
    addTerm(channel.name, 1.0);
    addCounter(channel.name, channel.grid, first);
  }
  for (const HotSpot& spot : settings.hot_spots) {
    const std::size_t first = recorder.terms_.size();
    for (const Influence& influence : spot.influences) addTerm(influence.channel, influence.factor);
    addCounter(hotSpotChannel(spot), spot.grid, first);
  }
  recorder.extremes_.resize(recorder.counters_.size());
  if (result.problems.empty()) result.value.emplace(std::move(recorder));
  return result;
}

double LifeRecorder::valueOf(std::size_t counter, const double* values) const noexcept {
  double value = 0.0;
  for (std::size_t t = sums_[counter].begin; t < sums_[counter].end; ++t)
    value += terms_[t].factor * values[terms_[t].input];
  return value;
}

/// Errors of samples are independent between the loads of one instant; the sizes of errors by constants add at most.
LoadError LifeRecorder::errorOf(std::size_t counter, const double* deviations, const double* common) const noexcept {
  double variance = 0.0, alike = 0.0;
  for (std::size_t t = sums_[counter].begin; t < sums_[counter].end; ++t) {
    const LoadError error = LoadError::at(terms_[t].input, deviations, common);
    variance += terms_[t].factor * terms_[t].factor * error.own * error.own;
    alike += std::abs(terms_[t].factor) * error.common;
  }
  return {std::sqrt(variance), alike};
}

void LifeRecorder::sample(std::int64_t stamp, const double* values, const double* deviations,
                          const double* common) noexcept {
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    const double value = valueOf(i, values);
    counters_[i].add(value);
    if (!CycleCounter::isLoad(value)) continue;
    const LoadError error = errorOf(i, deviations, common);
    counters_[i].addDeviation(error.deviation());
    extremes_[i].add(value, error);
  }
  lastUntil(stamp);
  if (!piece_begun_) {
    piece_begun_ = true;
    piece_start_ = stamp;
  }
}

void LifeRecorder::between(std::int64_t instant, const double* values, const double* deviations,
                           const double* common) noexcept {
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    const double value = valueOf(i, values);
    if (std::isnan(value)) continue;
    counters_[i].add(value);
    if (CycleCounter::isLoad(value)) extremes_[i].add(value, errorOf(i, deviations, common));
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
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    const LoadError error = extremes_[i].ofRange();
    counters_[i].addRange(extremes_[i].range(), error.own, error.common);
    extremes_[i] = {};
  }
}

void LifeRecorder::gap() noexcept {
  if (!contiguous_) return;  // before the first sample, or of one gap twice
  contiguous_ = false;
  for (CycleCounter& counter : counters_) counter.gap();
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
  piece.counts.reserve(counters_.size());
  for (CycleCounter& counter : counters_) piece.counts.push_back(counter.take());
  piece_begun_ = false;
  return piece;
}

}  // namespace hammer_loads::life
