/// Processing of a recording by the same functions as live messages.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/ros/bag_report.h"
#include "hammer_loads/ros/reference_table.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct BagJob {
  std::vector<std::string> inputs;  ///< bags of one recording
  std::string output;               ///< bag to write, which is overwritten; empty: none
  std::string tables;               ///< empty file, to get the results as tables (doc/tables.md); "": none
  life::PieceSink* pieces{};        ///< receiver of the counts of its runs; null: none
  /// Parameters over the shipped ones; empty: those of the recording's run_info, if it has one.
  std::optional<ParameterMap> parameters;
  /// Text of a URDF; empty: that of the recording's run_info, if it has one.
  std::optional<std::string> robot_description;
  /// Names of the topics; an empty one is replaced by that of the parameters (`input_topic_crank` ...) or the default.
  InputTopics topics;
  std::string output_prefix{"/hammer_loads"};
  bool pins{};                          ///< pin forces as well
  std::vector<MeasuredLoad> reference;  ///< measured load of the hull beside that of the bags
};

/// Reads the inputs' messages in record order and writes every output at the record time of the input that caused it.
/// A problem with a file begins with its name in the job.
/// progress: part done in [0, 1]. Returns one line for each problem. Without a problem the report is complete;
/// otherwise the output must not be used.
std::vector<std::string> processBag(const BagJob& job, const std::function<void(double)>& progress, BagReport& report);

}  // namespace hammer_loads
