/// The runs of a recording: times from which parameters apply.
#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Run of a node: messages from this record time until the next run begins are processed from an initial state.
struct BagRun {
  ros::Time from;
  Settings settings;  ///< with the names of the topics read
};

/// One run with the job's parameters, or one for each run_info of a hammer_loads node, from its record time on; the
/// first one also includes earlier messages. Notes state the parameters in use; `warnings` receives reasons to doubt
/// them.
Checked<std::vector<BagRun>> runsOf(const BagInputs& inputs, const BagJob& job, std::vector<BagWarning>& warnings);

/// Bags grouped by recording. A bag continues another one if it begins later with the run with which the other ends.
/// Runs are identified by their run_info; a bag without one, or one that cannot be read, is a recording of its own.
/// Splits are in the order of their times, recordings in the order of their first bags.
std::vector<std::vector<std::string>> recordingsOf(const std::vector<std::string>& files);

}  // namespace hammer_loads
