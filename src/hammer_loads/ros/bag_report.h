/// The report of process_bag.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

struct BagWarning {
  std::string key;     ///< equal for equal causes
  std::string text;    ///< one line: what is missing or suspicious
  std::int64_t run{};  ///< 1 for the first; 0: of the recording
};

struct BagReport {
  SampleCounts crank;        ///< counts of all runs
  std::uint64_t samples{};   ///< messages with crank samples
  std::uint64_t wrenches{};  ///< written
  std::uint64_t turns{};     ///< blows written
  std::uint64_t runs{};
  std::string prefix;                ///< prefix of the topics written; empty: no bag
  std::vector<std::string> notes;    ///< notes on what was used, one line each
  std::vector<BagWarning> warnings;  ///< none twice for the same run
};

/// Adds a line unless it is there already.
void addOnce(std::vector<std::string>& lines, const std::string& line);
void addOnce(std::vector<BagWarning>& warnings, const BagWarning& warning);

/// Each text once.
std::vector<std::string> textsOf(const std::vector<BagWarning>& warnings);

void add(const SampleCounts& counts, SampleCounts& sum);

/// Reasons of the samples without a result, one line each.
std::string textOf(const BagReport& report);

/// One line: samples, turns, what was written.
std::string summaryOf(const BagReport& report);

}  // namespace hammer_loads
