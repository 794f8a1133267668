#include "hammer_loads/life/exact_cycles.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/life/cycle_counter.h"

namespace hammer_loads::life {
namespace {

bool isLoad(double value) { return CycleCounter::isLoad(value); }

auto closeInto(ExactCycles::Closed& closed) {
  return [&closed](double b, double c) { ++closed[{std::min(b, c), std::max(b, c)}]; };
}

}  // namespace

void ExactCycles::add(double value) {
  if (!isLoad(value)) {
    ++tally_.skipped;
    return;
  }
  ++tally_.counted;
  extremes_.add(value);
  stack_.push(value + 0.0, closeInto(closed_));  // -0 is 0
}

void ExactCycles::append(const ExactCycles& later) {
  for (const auto& [extremes, count] : later.closed_) closed_[extremes] += count;
  const std::vector<double> points = later.residue();
  for (const double point : points) stack_.push(point, closeInto(closed_));
  tally_.add(later.tally_);
  extremes_.add(later.extremes_);
}

std::optional<ExactCycles> ExactCycles::restore(Closed closed, const std::vector<double>& residue,
                                                const SampleTally& tally, const Extremes& extremes) {
  ExactCycles restored;
  for (const auto& [pair, count] : closed) {
    if (!(isLoad(pair.first) && isLoad(pair.second) && pair.first < pair.second && count > 0)) return std::nullopt;
  }
  Closed further;
  for (const double point : residue) {
    if (!isLoad(point)) return std::nullopt;
    restored.stack_.push(point, closeInto(further));
  }
  if (restored.residue() != residue) return std::nullopt;
  restored.closed_ = std::move(closed);
  restored.tally_ = tally;
  restored.extremes_ = extremes;
  return restored;
}

std::vector<RangeMean> rangesAndMeans(const ExactCycles& count) {
  std::map<std::pair<double, double>, double> merged;  // by range and mean
  const auto add = [&](double low, double high, double cycles) { merged[{high - low, 0.5 * (low + high)}] += cycles; };
  for (const auto& [pair, cycles] : count.closed()) add(pair.first, pair.second, static_cast<double>(cycles));
  const std::vector<double>& residue = count.residue();
  for (std::size_t i = 1; i < residue.size(); ++i) {
    add(std::min(residue[i - 1], residue[i]), std::max(residue[i - 1], residue[i]), 0.5);
  }
  std::vector<RangeMean> result;
  result.reserve(merged.size());
  for (const auto& [key, cycles] : merged) result.push_back({key.first, key.second, cycles});
  return result;
}

}  // namespace hammer_loads::life
