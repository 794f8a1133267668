#include "hammer_loads/settings/input_topics.h"

#include <array>
#include <utility>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

constexpr std::array<std::pair<const char*, std::string InputTopics::*>, 4> kKeys{
    {{"input_topic_crank", &InputTopics::crank},
     {"input_topic_joint_states", &InputTopics::joint_states},
     {"input_topic_hull_imu", &InputTopics::hull_imu},
     {"input_topic_cylinder_pressures", &InputTopics::cylinder_pressures}}};

}  // namespace

InputTopics takeInputTopics(ParameterMap& parameters, std::vector<std::string>& problems) {
  InputTopics topics;
  for (const auto& [key, member] : kKeys) {
    const auto given = parameters.find(key);
    if (given == parameters.end()) continue;
    const Parameter& parameter = given->second;
    topics.*member = asText(parameter.value).value_or("");
    if ((topics.*member).empty())
      problems.push_back(std::string(key) + ": " + describe(parameter.value) + ", must be the name of a topic" +
                         (parameter.origin.empty() ? "" : " (" + parameter.origin + ")"));
    parameters.erase(given);
  }
  return topics;
}

std::string yamlOf(const InputTopics& topics) {
  std::string yaml;
  for (const auto& [key, member] : kKeys) {
    if (!(topics.*member).empty()) yaml += std::string(key) + ": " + quotedText(topics.*member) + "\n";
  }
  return yaml;
}

}  // namespace hammer_loads
