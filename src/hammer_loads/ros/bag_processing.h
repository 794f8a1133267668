/// Processing of a recording by the same functions as live messages, run by run.
#pragma once

#include <ros/time.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_report.h"
#include "hammer_loads/ros/reference_table.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct BagJob {
  std::vector<std::string> inputs;  ///< bags of one recording
  std::string output;               ///< bag to write, which is overwritten; empty: none
  std::string tables;               ///< empty file that receives the results as tables (doc/tables.md); "": none
  life::PieceSink* pieces{};        ///< receiver of the counts of its runs; null: none
  /// Parameters that replace shipped ones. Without them, those of the recording's run_info are used, if it has one.
  std::optional<ParameterMap> parameters;
  /// Text of a URDF; empty: that of the recording's run_info, if it has one.
  std::optional<std::string> robot_description;
  /// Names of the topics; an empty one is replaced by that of the parameters (`input_topic_crank` ...) or the default.
  InputTopics topics;
  std::string output_prefix{"/hammer_loads"};
  bool pins{};                          ///< pin forces are written as well
  std::vector<MeasuredLoad> reference;  ///< measured loads of the hull, in addition to those of the bags
};

/// Reads the inputs' messages in record order and writes every output at the record time of the input that caused it.
/// A problem with a file begins with its name in the job.
/// progress: receives the completed fraction in [0, 1]. Returns one line for each problem. Without a problem the report
/// is complete; otherwise the output must not be used.
std::vector<std::string> processBag(const BagJob& job, const std::function<void(double)>& progress, BagReport& report);

/// Run of a node: messages from this record time until the next run begins are processed from an initial state.
struct BagRun {
  ros::Time from;
  Settings settings;  ///< settings with the names of the topics read
};

/// Returns one run with the job's parameters, or one for each run_info of a hammer_loads node, from its record time on.
/// The first run also includes earlier messages. Notes state the parameters in use; `warnings` receives reasons to
/// doubt them.
Checked<std::vector<BagRun>> runsOf(const BagInputs& inputs, const BagJob& job, std::vector<BagWarning>& warnings);

/// Groups bags by recording. A bag continues another one if it begins later with the run with which the other ends.
/// Runs are identified by their run_info. A bag without one, or one that cannot be read, is a recording of its own.
/// Splits are in the order of their times, recordings in the order of their first bags.
std::vector<std::vector<std::string>> recordingsOf(const std::vector<std::string>& files);

}  // namespace hammer_loads
