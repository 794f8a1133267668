#include "hammer_loads/life/cycle_counter.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

namespace hammer_loads::life {

CycleCounter::CycleCounter(const LoadGrid& grid)
    : grid_(grid),
      classes_(grid.classes()),
      stack_(2 * classes_ + 1),
      cells_(newCells()),
      touched_(row(classes_) / kBlock + 1, 0) {
  overruns_.reserve(kOverruns);
  waiting_.fill(row(classes_));
}

void CycleCounter::Unmap::operator()(Cell* cells) const { munmap(cells, bytes); }

/// Anonymous pages, which occupy memory only once a cycle is counted in them. Heap memory would have to be cleared and
/// would thereby occupy all of it.
CycleCounter::Cells CycleCounter::newCells() const {
  const std::size_t bytes = (row(classes_) + 1) * sizeof(Cell);
  void* pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return Cells(static_cast<Cell*>(pages), Unmap{bytes});
}

void CycleCounter::settle() noexcept {
  const std::size_t spare = row(classes_);
  for (std::size_t& cell : waiting_) count(std::exchange(cell, spare));
  cells_[spare] = 0;
}

CycleCount CycleCounter::take() {
  Cells fresh = newCells();
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
    }
  }
  cells_ = std::move(fresh);  // gives back the pages that cycles of this period have touched
  std::sort(overruns_.begin(), overruns_.end());
  steps = 1;
  for (const std::uint32_t cell : overruns_) add(cell, kCellPeriod);
  overruns_.clear();
  sortClosed(count.closed);
  count.residue = stack_.residue();
  count.tally = std::exchange(tally_, {});
  count.extremes = std::exchange(extremes_, {});
  return count;
}

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
