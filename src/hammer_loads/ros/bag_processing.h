/// A recorded bag through the same flow as live messages.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hammer_loads/parameters/load.h"
#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

struct BagJob {
  std::string input, output;
  std::string crank_topic{"/hammer/crank"};
  std::string joint_topic{"/joint_states"};
  std::string output_prefix{"/hammer_loads"};
  bool pins{};  ///< pin forces as well
};

/// Reads the input's messages in their order of arrival and writes every output at the record time of the input that
/// caused it. The output appears under its name only when it is complete. progress: part done in [0, 1].
/// Returns what went wrong in one line, empty if nothing did.
std::string processBag(const BagJob& job, const Settings& settings, const std::function<void(double)>& progress, IntakeCounts& counts);

}  // namespace hammer_loads
