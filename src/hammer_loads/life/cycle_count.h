/// A count of load cycles on a grid: closed cycles, residue and the number of samples left out. Counts add exactly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "hammer_loads/util/checked.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::life {

/// Class i holds [least + i width, least + (i + 1) width) and stands for its centre; the last one holds `greatest` too.
/// The error of an extreme is at most half a width, that of a range less than one width.
class LoadGrid {
 public:
  static constexpr std::uint32_t kMostClasses = 16384;  ///< a matrix of 268 MB

  /// `least` < `greatest`, both finite, in the channel's unit; 2 to kMostClasses classes.
  static Checked<LoadGrid> make(double least, double greatest, std::int64_t classes);

  double least() const { return least_; }
  double greatest() const { return greatest_; }
  std::uint32_t classes() const { return classes_; }
  double width() const { return width_; }  ///< [channel's unit]

  /// Class of a value within the full scale; values beyond it fall into the outer classes.
  std::uint32_t classOf(double value) const noexcept {
    const double place = (value - least_) * per_width_;
    if (!(place > 0.0)) return 0;
    return place < last_ ? static_cast<std::uint32_t>(place) : classes_ - 1;
  }
  /// Centre of a class.
  double level(std::uint32_t index) const noexcept { return least_ + (index + 0.5) * width_; }
  /// Between the centres of two classes that are `steps` apart.
  double range(std::uint32_t steps) const noexcept { return steps * width_; }
  /// Middle between the centres of class `low` and of the one `steps` above.
  double mean(std::uint32_t low, std::uint32_t steps) const noexcept {
    return least_ + (low + 0.5 * steps + 0.5) * width_;
  }

  bool operator==(const LoadGrid& other) const {
    return least_ == other.least_ && greatest_ == other.greatest_ && classes_ == other.classes_;
  }

 private:
  LoadGrid(double least, double greatest, std::uint32_t classes)
      : least_(least),
        greatest_(greatest),
        classes_(classes),
        width_((greatest - least) / classes),
        per_width_(classes / (greatest - least)),
        last_(classes - 1.0) {}

  double least_, greatest_;
  std::uint32_t classes_;
  double width_, per_width_, last_;
};

/// Closed cycles between class `low` and class `low + steps`.
struct ClosedCycles {
  std::uint32_t steps{};  ///< range in classes, >= 1
  std::uint32_t low{};    ///< class of the lower extreme
  std::uint64_t count{};

  /// Cycles between two classes, in any order.
  static ClosedCycles between(std::uint32_t b, std::uint32_t c, std::uint64_t count) {
    return {std::max(b, c) - std::min(b, c), std::min(b, c), count};
  }
  bool operator==(const ClosedCycles& o) const { return steps == o.steps && low == o.low && count == o.count; }
  /// By range, then by mean.
  bool operator<(const ClosedCycles& o) const { return steps != o.steps ? steps < o.steps : low < o.low; }
};

/// Number of samples so far, by their treatment.
struct SampleTally {
  std::uint64_t counted{};  ///< samples with a value; saturated ones are among them
  std::uint64_t skipped{};  ///< not a number or infinite: the series goes on without them
  std::uint64_t below{};    ///< saturated: below the full scale, counted in the lowest class
  std::uint64_t above{};    ///< saturated: above the full scale, counted in the highest class
  std::uint64_t gaps{};     ///< places where samples are missing; the series goes on over them
  /// Standard deviations given with the samples, and their sum in 1/1024 of a class width: whole numbers, so that
  /// pieces add exactly.
  std::uint64_t deviations{}, deviation_sum{};
  /// Ranges of turns and their standard deviations, weighted by the range: sums of R^2, R own and R common in
  /// 1/kRangeUnits of a class width squared, whole numbers as above.
  std::uint64_t range_square{}, range_own{}, range_common{};

  void add(const SampleTally& o);
};

/// Numbers of a tally with the names of their columns in a ledger.
struct TallyColumn {
  const char* name;
  std::uint64_t SampleTally::*number;
};
inline constexpr TallyColumn kTallyColumns[] = {{"counted", &SampleTally::counted},
                                                {"skipped", &SampleTally::skipped},
                                                {"below", &SampleTally::below},
                                                {"above", &SampleTally::above},
                                                {"gaps", &SampleTally::gaps},
                                                {"deviations", &SampleTally::deviations},
                                                {"deviation_sum", &SampleTally::deviation_sum},
                                                {"range_square", &SampleTally::range_square},
                                                {"range_own", &SampleTally::range_own},
                                                {"range_common", &SampleTally::range_common}};

constexpr double kDeviationUnits = 1024.0;  ///< per class width, in SampleTally::deviation_sum
constexpr double kRangeUnits = 64.0;        ///< per class width squared, in its sums of ranges: for 1e10 turns

/// Smallest and largest value that came in, not rounded to the grid; NaN before the first one.
struct Extremes {
  double least{kNaN};
  double greatest{kNaN};

  void add(double value) noexcept {
    if (!(value >= least)) least = value;
    if (!(value <= greatest)) greatest = value;
  }
  void add(const Extremes& o) noexcept {
    if (o.least == o.least) add(o.least), add(o.greatest);
  }
};

struct CycleCount {
  LoadGrid grid;
  std::vector<ClosedCycles> closed;  ///< sorted, each (steps, low) once
  /// Classes of the turning points that closed no cycle, in time order: at most 2 classes - 1, the running end
  /// included.
  std::vector<std::uint32_t> residue;
  SampleTally tally;
  Extremes extremes;

  explicit CycleCount(const LoadGrid& on) : grid(on) {}

  /// Extends the count by a later one of the same series: `since` contains the cycles closed since then and the residue
  /// of the whole.
  void advance(const CycleCount& since);
};

/// Sorts the cycles and merges those of equal range and mean.
void sortClosed(std::vector<ClosedCycles>& closed);

/// Mean standard deviation of a sample [channel's unit]; NaN where none was given.
double meanDeviation(const CycleCount& count);

/// Standard deviations of ranges.
struct RangeDeviation {
  double absolute{};  ///< equal for all ranges, in the channel's unit; used where turns give no information
  double own{};       ///< part of single revolutions, over the range [-]
  double common{};    ///< part of constants, equal in all revolutions, over the range [-]; NaN: not known separately
};
/// Errors by the ranges of turns; without turns by the samples, whose errors at a range's two ends are independent.
RangeDeviation rangeDeviation(const CycleCount& count);

/// Range and mean in the channel's unit; `count` is a multiple of 1/2.
struct RangeMean {
  double range{}, mean{}, count{};
};

/// Closed cycles and the residue as half cycles, sorted by range, then by mean: the count of ASTM E1049-85 5.4.4.
std::vector<RangeMean> rangesAndMeans(const CycleCount& count);

}  // namespace hammer_loads::life
