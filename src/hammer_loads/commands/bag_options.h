/// Options common to the commands that read a recording: names of topics, and parameter files in place of a run_info.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/ros/bag_processing.h"

namespace hammer_loads {

inline CLI::Option* addTopicOption(CommandLine& line, InputTopics& topics, std::string InputTopics::*topic) {
  const auto* input =
      std::find_if(kInputs.begin(), kInputs.end(), [topic](const InputName& one) { return one.topic == topic; });
  return line.add_option(input->option, topics.*topic)
      ->type_name("TOPIC")
      ->default_str(std::string("as in run_info, else ") + input->recorded);
}

/// Parameters and robot description of the job, or the problems of their files, one line each.
inline std::vector<std::string> readParameterFiles(const std::vector<std::string>& params, const std::string& urdf,
                                                   BagJob& job) {
  std::vector<std::string> problems;
  ParameterMap parameters;
  if (!params.empty() && addFiles(params, parameters, problems)) job.parameters = std::move(parameters);
  if (urdf.empty()) return problems;
  Checked<std::string> description = fileText(urdf);
  problems.insert(problems.end(), description.problems.begin(), description.problems.end());
  job.robot_description = std::move(description.value);
  return problems;
}

}  // namespace hammer_loads
