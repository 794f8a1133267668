/// The report of process_bag, and what is missing or suspicious in a recording.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

class BagInputs;
struct BagRun;
class HammerBridge;

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

/// Warnings by the pipeline's state at the end of a run: wrong units, joints without a message.
/// joints_came: there were messages on their topic. run: number of the run.
void warnOfRun(const HammerBridge& bridge, bool joints_came, std::int64_t run, std::vector<BagWarning>& warnings);

/// Warnings on the recording as a whole: several publishers on one of the topics read, messages that its log has lost
/// or that are of another version of this package, topics that the runs need and that were not heard.
void warnOfRecording(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& topics,
                     const std::set<std::string>& heard, std::vector<BagWarning>& warnings);

/// Warns if there is no wrench, or if there is no whole turn and most samples contradict the parameters.
bool isUseless(const BagReport& report);

/// Warnings that the crank's readings are not those of such a machine, in one line.
std::string contradictionsOf(const std::vector<BagWarning>& warnings);

/// Reason why a run gave no wrench of use, in one line.
std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report);

}  // namespace hammer_loads
