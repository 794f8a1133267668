/// Parameters in force as texts, beside the shipped ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hammer_loads {

struct ParameterText {
  std::string key, value;
  std::optional<std::string> shipped;  ///< value in the shipped files, if one has the key
  bool of_machine{};                   ///< of hammer or boom, not of pipeline, log and counting
};

/// From Settings::yaml, sorted by key; equal values have equal texts. config_directory: of the shipped files.
std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml);

/// What makes two runs those of one machine: its parameters and robot description. The drive's inertia is left out:
/// `calibrate` finds a better one for the same machine.
std::string machineText(const std::vector<ParameterText>& parameters, const std::string& robot_description);

}  // namespace hammer_loads
