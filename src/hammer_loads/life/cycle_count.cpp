#include "hammer_loads/life/cycle_count.h"

#include <algorithm>

#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

Checked<LoadGrid> LoadGrid::make(double least, double greatest, std::int64_t classes) {
  Checked<LoadGrid> result;
  const double span = greatest - least;
  if (!(std::isfinite(span) && span > 0.0))
    result.problems.push_back(
        format("full scale: %.17g to %.17g, must be finite and the first below the second", least, greatest));
  if (classes < 2 || classes > kMostClasses)
    result.problems.push_back(format("classes: %lld, must be an integer in [2, %u]", static_cast<long long>(classes),
                                     static_cast<unsigned>(kMostClasses)));
  if (!result.problems.empty()) return result;
  const LoadGrid grid(least, greatest, static_cast<std::uint32_t>(classes));
  // Else neighbouring classes would have the same centre, or the width could not be inverted.
  const bool distinct = grid.level(0) < grid.level(1) && grid.level(grid.classes_ - 2) < grid.level(grid.classes_ - 1);
  if (!distinct || !std::isfinite(grid.per_width_)) {
    result.problems.push_back(
        format("full scale: %.17g to %.17g, must be wide enough for %u classes", least, greatest, grid.classes_));
    return result;
  }
  result.value = grid;
  return result;
}

void SampleTally::add(const SampleTally& o) {
  for (const TallyColumn& column : kTallyColumns) this->*column.number += o.*column.number;
}

void sortClosed(std::vector<ClosedCycles>& closed) {
  std::sort(closed.begin(), closed.end());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const bool same = kept > 0 && closed[kept - 1].steps == closed[i].steps && closed[kept - 1].low == closed[i].low;
    if (same) {
      closed[kept - 1].count += closed[i].count;
    } else {
      closed[kept++] = closed[i];
    }
  }
  closed.resize(kept);
}

void CycleCount::advance(const CycleCount& since) {
  closed.insert(closed.end(), since.closed.begin(), since.closed.end());
  sortClosed(closed);
  residue = since.residue;
  tally.add(since.tally);
  extremes.add(since.extremes);
}

double meanDeviation(const CycleCount& count) {
  if (count.tally.deviations == 0) return kNaN;
  return static_cast<double>(count.tally.deviation_sum) / static_cast<double>(count.tally.deviations) *
         (count.grid.width() / kDeviationUnits);
}

RangeDeviation rangeDeviation(const CycleCount& count) {
  const SampleTally& t = count.tally;
  if (t.range_square == 0) return {std::sqrt(2.0) * meanDeviation(count), 0.0, kNaN};
  const auto square = static_cast<double>(t.range_square);
  return {0.0, static_cast<double>(t.range_own) / square, static_cast<double>(t.range_common) / square};
}

std::vector<RangeMean> rangesAndMeans(const CycleCount& count) {
  std::vector<ClosedCycles> halves = count.closed;
  for (ClosedCycles& cycles : halves) cycles.count *= 2;
  for (std::size_t i = 1; i < count.residue.size(); ++i)
    halves.push_back(ClosedCycles::between(count.residue[i - 1], count.residue[i], 1));
  sortClosed(halves);
  std::vector<RangeMean> result;
  result.reserve(halves.size());
  for (const ClosedCycles& half : halves) {
    result.push_back(
        {count.grid.range(half.steps), count.grid.mean(half.low, half.steps), 0.5 * static_cast<double>(half.count)});
  }
  return result;
}

}  // namespace hammer_loads::life
