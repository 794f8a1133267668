#include "hammer_loads/life/cycle_counter.h"

#include <algorithm>
#include <new>
#include <utility>

namespace hammer_loads::life {

CycleCounter::CycleCounter(const LoadGrid& grid)
    : grid_(grid),
      classes_(grid.classes()),
      stack_(2 * classes_ + 1),
      // Not a vector: pages without a cycle cost no memory.
      cells_(static_cast<Cell*>(std::calloc(row(classes_) + 1, sizeof(Cell)))),
      touched_(row(classes_) / kBlock + 1, 0) {
  if (!cells_) throw std::bad_alloc();
  overruns_.reserve(kOverruns);
  waiting_.fill(row(classes_));
}

void CycleCounter::settle() noexcept {
  const std::size_t spare = row(classes_);
  for (std::size_t& cell : waiting_) count(std::exchange(cell, spare));
  cells_[spare] = 0;
}

CycleCount CycleCounter::take() {
  settle();
  CycleCount count(grid_);
  const std::size_t cells = row(classes_);
  std::size_t steps = 1;
  const auto add = [&](std::size_t cell, std::uint64_t cycles) {
    while (row(steps + 1) <= cell) ++steps;
    count.closed.push_back({static_cast<std::uint32_t>(steps), static_cast<std::uint32_t>(cell - row(steps)), cycles});
  };
  for (std::size_t block = 0; block < touched_.size(); ++block) {
    if (touched_[block] == 0) continue;
    touched_[block] = 0;
    const std::size_t end = std::min(cells, (block + 1) * kBlock);
    for (std::size_t cell = block * kBlock; cell < end; ++cell) {
      if (cells_[cell] == 0) continue;
      add(cell, cells_[cell]);
      cells_[cell] = 0;
    }
  }
  if (!overruns_.empty()) {
    std::sort(overruns_.begin(), overruns_.end());
    steps = 1;
    for (const std::uint32_t cell : overruns_) add(cell, kCellPeriod);
    overruns_.clear();
    sortClosed(count.closed);
  }
  count.residue = stack_.residue();
  count.tally = std::exchange(tally_, {});
  count.extremes = std::exchange(extremes_, {});
  return count;
}

}  // namespace hammer_loads::life
