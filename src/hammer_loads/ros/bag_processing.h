/// A recorded bag through the same flow as live messages.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/grapple_settings.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct BagJob {
  std::string input, output;
  std::string crank_topic{"/hammer/crank"};
  std::string joint_topic{"/joint_states"};
  std::string imu_topic{"/hammer/hull_imu"};  ///< read with hull_motion imu alone
  std::string output_prefix{"/hammer_loads"};
  bool pins{};                             ///< pin forces as well
  std::optional<GrappleSettings> grapple;  ///< the grapple as well; then a bag without the crank topic will do
  std::string grapple_prefix{"/grapple"};
};

struct BagReport {
  SampleCounts crank;
  std::string grapple;  ///< refusalReport of the grapple, if there was one
};

/// Reads the input's messages in their order of arrival and writes every output at the record time of the input that
/// caused it. The output appears under its name only when it is complete. progress: part done in [0, 1].
/// Returns what went wrong in one line, empty if nothing did.
std::string processBag(const BagJob& job, const Settings& settings, const std::function<void(double)>& progress,
                       BagReport& report);

/// What a user should know of the samples that gave nothing, one line each.
std::string textOf(const BagReport& report);

}  // namespace hammer_loads
