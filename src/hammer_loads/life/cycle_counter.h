/// Counters of the load cycles of one channel: on a grid, sample by sample, in some ns each and without allocation; or
/// of every value as it is.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/four_point.h"

namespace hammer_loads::life {

/// A value that is not finite or is larger than kLargestLoad is no load: the sample is ignored and counted as skipped.
/// A value beyond the full scale is counted in the outer class, and as saturated.
///
/// Closed cycles lie in a dense range-mean matrix of classes (classes - 1)/2 cells of 2 byte, by range, then by mean:
/// 17 MB of address space at 4096 classes, of which only pages with cycles occupy memory. Cycles of similar range are
/// neighbours, so that a repeating load stays in the cache. Noise over the whole scale uses another page each time.
/// Therefore cells are small, overflows of cells are listed, and cycles are buffered while their cells are fetched.
class CycleCounter {
 public:
  /// Throws std::bad_alloc when there is not enough address space.
  explicit CycleCounter(const LoadGrid& grid);

  void add(double value) noexcept {
    if (!isLoad(value)) {
      ++tally_.skipped;
      return;
    }
    ++tally_.counted;
    tally_.below += value < grid_.least() ? 1U : 0U;
    tally_.above += value > grid_.greatest() ? 1U : 0U;
    extremes_.add(value);
    stack_.push(grid_.classOf(value), [this](std::uint32_t b, std::uint32_t c) { close(b, c); });
  }
  /// Standard deviation of the sample just added [channel's unit]; NaN: none. Beyond the full scale it counts as that.
  void addDeviation(double deviation) noexcept {
    if (!(deviation >= 0.0)) return;
    const double units = std::fmin(deviation / grid_.width(), static_cast<double>(classes_)) * kDeviationUnits;
    ++tally_.deviations;
    tally_.deviation_sum += static_cast<std::uint64_t>(units + 0.5);
  }
  /// Range of a turn and its standard deviations [channel's unit]; values that are not finite are ignored.
  void addRange(double range, double own, double common) noexcept {
    if (!(range > 0.0 && own >= 0.0 && common >= 0.0)) return;
    const auto classes = [&](double value) { return std::fmin(value / grid_.width(), static_cast<double>(classes_)); };
    const double weight = kRangeUnits * classes(range);
    tally_.range_square += static_cast<std::uint64_t>(weight * classes(range) + 0.5);
    tally_.range_own += static_cast<std::uint64_t>(weight * classes(own) + 0.5);
    tally_.range_common += static_cast<std::uint64_t>(weight * classes(common) + 0.5);
  }
  /// Notes that samples are missing here. The series continues; the cycle across the gap is a lower bound of what has
  /// occurred.
  void gap() noexcept { ++tally_.gaps; }

  const LoadGrid& grid() const { return grid_; }
  const SampleTally& tally() const { return tally_; }  ///< since the last take()

  /// Closed cycles, tally and extremes since the last take(), and the whole residue. For the end of a period, not for
  /// the hot path.
  CycleCount take();

  static constexpr double kLargestLoad = 1e300;  ///< ranges of larger values could not be written down
  static bool isLoad(double value) noexcept { return std::abs(value) <= kLargestLoad; }

 private:
  using Cell = std::uint16_t;
  static constexpr std::uint64_t kCellPeriod = 65536;
  static constexpr std::size_t kBlock = 4096 / sizeof(Cell);  ///< cells of a page
  /// Cells run over before memory is taken: 4e9 cycles, 100 days at 1 kHz without a take().
  static constexpr std::size_t kOverruns = 65536;
  static constexpr std::size_t kWaiting = 16;  ///< number of buffered cycles; a fetch from memory takes some hundred ns

  struct Unmap {
    std::size_t bytes{};
    void operator()(Cell* cells) const;
  };
  using Cells = std::unique_ptr<Cell[], Unmap>;
  Cells newCells() const;
  std::size_t row(std::size_t steps) const { return (steps - 1) * (2 * classes_ - steps) / 2; }
  void close(std::uint32_t b, std::uint32_t c) noexcept {
    const std::uint32_t low = b < c ? b : c, steps = b < c ? c - b : b - c;
    const std::size_t cell = row(steps) + low;
    prefetchToWrite(&cells_[cell]);
    next_ = (next_ + 1) % kWaiting;
    count(std::exchange(waiting_[next_], cell));
  }
  void count(std::size_t cell) noexcept {
    if (++cells_[cell] == 0) overruns_.push_back(static_cast<std::uint32_t>(cell));
    touched_[cell / kBlock] = 1;
  }
  static void prefetchToWrite(const void* address) noexcept {
#if defined(__GNUC__)
    __builtin_prefetch(address, 1);
#else
    static_cast<void>(address);
#endif
  }
  /// Counts the waiting cycles.
  void settle() noexcept;

  LoadGrid grid_;
  std::size_t classes_;
  FourPointStack<std::uint32_t> stack_;
  Cells cells_;                                  ///< and a spare one, for a place in waiting_ without a cycle
  std::vector<std::uint32_t> overruns_;          ///< cells, one entry for each kCellPeriod cycles
  std::array<std::size_t, kWaiting> waiting_{};  ///< cells
  std::size_t next_{};                           ///< in waiting_
  std::vector<std::uint8_t> touched_;            ///< blocks with a cycle since the last take()
  SampleTally tally_;
  Extremes extremes_;
};

/// Counts the load cycles of a series without a grid. It is meant for recordings and not for a live node, since nearly
/// equal peaks do not close a cycle and the residue is not bounded.
class ExactCycles {
 public:
  /// Adds a value; one that is no load (CycleCounter::isLoad) is skipped and counted.
  void add(double value);

  /// Closed cycles by lower and upper extreme.
  using Closed = std::map<std::pair<double, double>, std::uint64_t>;
  const Closed& closed() const { return closed_; }
  const std::vector<double>& residue() const { return stack_.residue(); }
  const SampleTally& tally() const { return tally_; }

 private:
  FourPointStack<double> stack_;
  Closed closed_;
  SampleTally tally_;
};

/// Closed cycles and the residue as half cycles, sorted by range, then by mean.
std::vector<RangeMean> rangesAndMeans(const ExactCycles& count);

}  // namespace hammer_loads::life
