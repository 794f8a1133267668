#include "hammer_loads/settings/retired_keys.h"

#include <array>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

struct RetiredKey {
  const char* key;
  const char* remains;  ///< the one value that still holds
};

constexpr std::array<RetiredKey, 1> kRetired{{{"crank_estimator", "mechanism"}}};

}  // namespace

void dropRetiredKeys(ParameterMap& parameters, std::vector<std::string>& notes) {
  for (const auto& [key, remains] : kRetired) {
    const auto given = parameters.find(key);
    if (given == parameters.end()) continue;
    const Parameter& parameter = given->second;
    if (asText(parameter.value) != remains)
      notes.push_back(std::string(key) + ": " + describe(parameter.value) + ", of an earlier version, is ignored: " +
                      remains + " is used" + (parameter.origin.empty() ? "" : " (" + parameter.origin + ")"));
    parameters.erase(given);
  }
}

}  // namespace hammer_loads
