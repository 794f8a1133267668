/// Report of process_bag, with warnings of missing or suspicious content of a recording.
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
  std::int64_t run{};  ///< number of the run, from 1; 0: the recording as a whole
};

struct BagReport {
  SampleCounts crank;        ///< counts of all runs
  std::uint64_t samples{};   ///< messages with crank samples
  std::uint64_t wrenches{};  ///< wrenches written
  std::uint64_t turns{};     ///< blows written
  std::uint64_t runs{};
  std::string prefix;                ///< prefix of the topics written; empty: no bag
  std::vector<std::string> notes;    ///< notes on the parameters in use, one line each
  std::vector<BagWarning> warnings;  ///< no warning occurs twice for a run
};

/// Adds a line unless it is there already.
void addOnce(std::vector<std::string>& lines, const std::string& line);
void addOnce(std::vector<BagWarning>& warnings, const BagWarning& warning);

/// Returns each text once.
std::vector<std::string> textsOf(const std::vector<BagWarning>& warnings);

void add(const SampleCounts& counts, SampleCounts& sum);

/// Returns the reasons for samples without a result, one line each.
std::string textOf(const BagReport& report);

/// Returns one line with the numbers of samples, wrenches, turns and runs and the prefix of the topics written.
std::string summaryOf(const BagReport& report);

/// Adds warnings from the pipeline's state at the end of a run, such as wrong units or joints without a message.
/// joints_came: messages were received on their topic. run: number of the run.
void warnOfRun(const HammerBridge& bridge, bool joints_came, std::int64_t run, std::vector<BagWarning>& warnings);

/// Adds warnings of the recording as a whole: several publishers on one of the topics read, messages that its log lost
/// or that are of another version of this package, and required topics without a message.
void warnOfRecording(const BagInputs& inputs, const std::vector<BagRun>& runs, const std::set<std::string>& topics,
                     const std::set<std::string>& heard, std::vector<BagWarning>& warnings);

/// Returns true if no wrench is usable: none, one accepted sample, or contradicting samples and no whole revolution.
bool isUseless(const BagReport& report);

/// Returns the warnings that the crank's readings contradict the parameters of the machine, in one line.
std::string contradictionsOf(const std::vector<BagWarning>& warnings);

/// Returns the reason why a run gave no usable wrench, in one line.
std::string noWrench(const BagInputs& inputs, const BagRun& run, const BagReport& report);

}  // namespace hammer_loads
