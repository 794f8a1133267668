#include "hammer_loads/life/cycle_count.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "hammer_loads/life/four_point.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/number_text.h"

namespace hammer_loads::life {
namespace {

ClosedCycles between(std::uint32_t b, std::uint32_t c, std::uint64_t count) {
  return {std::max(b, c) - std::min(b, c), std::min(b, c), count};
}

}  // namespace

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

bool SampleTally::operator==(const SampleTally& o) const {
  return std::all_of(std::begin(kTallyColumns), std::end(kTallyColumns),
                     [&](const TallyColumn& column) { return this->*column.number == o.*column.number; });
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

void joinResidues(std::vector<std::uint32_t>& residue, const std::vector<std::uint32_t>& later,
                  std::vector<ClosedCycles>& closed) {
  FourPointStack<std::uint32_t> stack(residue.size() + later.size());
  const auto close = [&](std::uint32_t b, std::uint32_t c) { closed.push_back(between(b, c, 1)); };
  for (const std::uint32_t point : residue) stack.push(point, close);
  for (const std::uint32_t point : later) stack.push(point, close);
  residue = stack.residue();
}

void CycleCount::append(const CycleCount& later) {
  std::vector<std::uint32_t> joined = residue;
  joinResidues(joined, later.residue, closed);
  advance(later);
  residue = std::move(joined);
}

void CycleCount::advance(const CycleCount& since) {
  closed.insert(closed.end(), since.closed.begin(), since.closed.end());
  sortClosed(closed);
  residue = since.residue;
  tally.add(since.tally);
  extremes.add(since.extremes);
}

bool isPossible(const CycleCount& count) {
  const std::uint32_t classes = count.grid.classes();
  const ClosedCycles* before = nullptr;
  for (const ClosedCycles& cycles : count.closed) {
    if (cycles.steps == 0 || cycles.steps >= classes || cycles.low >= classes - cycles.steps) return false;
    if (cycles.count == 0 || (before != nullptr && !(*before < cycles))) return false;
    before = &cycles;
  }
  for (const std::uint32_t point : count.residue) {
    if (point >= classes) return false;
  }
  std::vector<std::uint32_t> joined;
  std::vector<ClosedCycles> closed;
  joinResidues(joined, count.residue, closed);
  return joined == count.residue;
}

double meanDeviation(const CycleCount& count) {
  if (count.tally.deviations == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(count.tally.deviation_sum) / static_cast<double>(count.tally.deviations) *
         (count.grid.width() / kDeviationUnits);
}

RangeDeviation rangeDeviation(const CycleCount& count) {
  const SampleTally& t = count.tally;
  if (t.range_square == 0)
    return {std::sqrt(2.0) * meanDeviation(count), 0.0, std::numeric_limits<double>::quiet_NaN()};
  const auto square = static_cast<double>(t.range_square);
  return {0.0, static_cast<double>(t.range_own) / square, static_cast<double>(t.range_common) / square};
}

std::vector<RangeMean> rangesAndMeans(const CycleCount& count) {
  std::vector<ClosedCycles> halves = count.closed;
  for (ClosedCycles& cycles : halves) cycles.count *= 2;
  for (std::size_t i = 1; i < count.residue.size(); ++i) {
    halves.push_back(between(count.residue[i - 1], count.residue[i], 1));
  }
  sortClosed(halves);
  std::vector<RangeMean> result;
  result.reserve(halves.size());
  for (const ClosedCycles& half : halves) {
    result.push_back(
        {count.grid.range(half.steps), count.grid.mean(half.low, half.steps), 0.5 * static_cast<double>(half.count)});
  }
  return result;
}

std::string csvText(const std::vector<RangeMean>& cycles) {
  std::string text = "range,mean,count\n";
  for (const RangeMean& c : cycles)
    text += shortNumber(c.range) + ',' + shortNumber(c.mean) + ',' + shortNumber(c.count) + '\n';
  return text;
}

}  // namespace hammer_loads::life
