/// The shipped hammer file as text with keys altered or left out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads::test {

/// Returns the file with these texts in place of values; an empty text leaves the key out.
inline std::string hammerYaml(const std::map<std::string, std::string>& altered = {}) {
  std::vector<std::string> problems;
  const ParameterMap shipped = readParameterFile(configDirectory() + "/hammer_mo100.yaml", problems).value();
  std::string yaml;
  for (const std::string& key : hammerKeys()) {
    const auto found = altered.find(key);
    const std::string value = found == altered.end() ? shipped.at(key).value.Scalar() : found->second;
    if (!value.empty()) yaml += key + ": " + value + "\n";
  }
  return yaml;
}

}  // namespace hammer_loads::test
