/// A count as text, so that two can be compared and a difference is printed. Ranges of turns are left out: the turn in
/// which a recording is cut belongs to neither part.
#pragma once

#include <cinttypes>
#include <string>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

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

}  // namespace hammer_loads::life
