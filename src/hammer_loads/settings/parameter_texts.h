/// Parameters in force as texts, beside the shipped ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hammer_loads {

struct ParameterText {
  std::string key, value;
  std::optional<std::string> shipped;  ///< value in the shipped files, if one has the key
};

/// From Settings::yaml, sorted by key; equal values have equal texts. config_directory: of the shipped files.
std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml);

}  // namespace hammer_loads
