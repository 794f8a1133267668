/// The runs of a recording: from when on which parameters apply.
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

/// One run with the job's parameters, or one for each run_info of a hammer_loads node: from its record time on, the
/// first one also for what comes before it. Notes state what is used; what makes it uncertain is added to `warnings`.
Checked<std::vector<BagRun>> runsOf(const BagInputs& inputs, const BagJob& job, std::vector<BagWarning>& warnings);

/// Bags by the recordings that they are splits of: one goes on where the run that it ends with is the one that another
/// begins with, later. Runs are known by their run_info; a bag without one, or one that cannot be read, is alone. The
/// splits in the order of their times, the recordings in that of their first bags given.
std::vector<std::vector<std::string>> recordingsOf(const std::vector<std::string>& files);

}  // namespace hammer_loads
