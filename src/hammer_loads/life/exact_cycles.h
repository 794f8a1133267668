/// Counts the load cycles of a series without a grid. It is meant for recordings and not for a live node, since nearly
/// equal peaks do not close a cycle and the residue is not bounded.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/four_point.h"

namespace hammer_loads::life {

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
