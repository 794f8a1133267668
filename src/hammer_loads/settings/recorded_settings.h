/// Settings from a run_info, which another version of this package may have written; parameters in force as texts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// parameters_yaml: every parameter in force when it was written. A pipeline or log key that this version does not know
/// is ignored, one that it knows and that is not there has the value shipped in `config_directory`; a note names each.
/// Notes of the parameters themselves are in the settings alone.
Checked<Settings> loadRecorded(const std::string& config_directory, const std::string& parameters_yaml,
                               const std::string& robot_description);

/// The parameters of a run_info; nothing, with the reason in `problems`, where it is no YAML map.
std::optional<ParameterMap> recordedParameters(const std::string& parameters_yaml, std::vector<std::string>& problems);

struct ParameterText {
  std::string key, value;
  std::optional<std::string> shipped;  ///< value in the shipped files, if one has the key
};

/// From Settings::yaml, sorted by key; equal values have equal texts. config_directory: of the shipped files.
std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml);

}  // namespace hammer_loads
