#include "hammer_loads/life/exact_cycles.h"

#include <algorithm>

#include "hammer_loads/life/cycle_counter.h"

namespace hammer_loads::life {

void ExactCycles::add(double value) {
  if (!CycleCounter::isLoad(value)) {
    ++tally_.skipped;
    return;
  }
  ++tally_.counted;
  const auto close = [this](double b, double c) { ++closed_[{std::min(b, c), std::max(b, c)}]; };
  stack_.push(value + 0.0, close);  // -0 is 0
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
