/// Counts as texts, sums of counts, and what every count has.
#pragma once

#include <cinttypes>
#include <string>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/four_point.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

/// A count as text, so that two can be compared and a difference is printed. Ranges of turns are left out: the turn in
/// which a recording is cut belongs to neither part.
inline std::string textOf(const CycleCount& count) {
  const SampleTally& t = count.tally;
  std::string text =
      format("grid %.17g %.17g %u\ntally", count.grid.least(), count.grid.greatest(), count.grid.classes());
  for (const std::uint64_t value : {t.counted, t.skipped, t.below, t.above, t.gaps, t.deviations, t.deviation_sum})
    text += format(" %" PRIu64, value);
  text += format("\nextremes %.17g %.17g\n", count.extremes.least, count.extremes.greatest);
  for (const ClosedCycles& c : count.closed) text += format("%u %u %" PRIu64 "\n", c.steps, c.low, c.count);
  for (const std::uint32_t point : count.residue) text += format("residue %u\n", point);
  return text;
}

/// Continues the series of `count` with the one of `later`, on the same grid.
inline void append(const CycleCount& later, CycleCount& count) {
  FourPointStack<std::uint32_t> stack;
  const auto close = [&](std::uint32_t b, std::uint32_t c) { count.closed.push_back(ClosedCycles::between(b, c, 1)); };
  for (const std::vector<std::uint32_t>& residue : {count.residue, later.residue})
    for (const std::uint32_t point : residue) stack.push(point, close);
  count.advance(later);
  count.residue = stack.residue();
}

/// Returns true if a series can have this count: cycles on the grid and sorted, none left in the residue.
inline bool isPossible(const CycleCount& count) {
  CycleCount again(count.grid);
  append(count, again);
  bool on_grid = textOf(again) == textOf(count);
  for (const ClosedCycles& c : count.closed)
    on_grid = on_grid && c.count > 0 && c.steps > 0 && c.low + c.steps < count.grid.classes();
  for (const std::uint32_t point : count.residue) on_grid = on_grid && point < count.grid.classes();
  return on_grid;
}

}  // namespace hammer_loads::life
