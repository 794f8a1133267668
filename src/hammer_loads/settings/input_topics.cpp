#include "hammer_loads/settings/input_topics.h"

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {

InputTopics takeInputTopics(ParameterMap& parameters, std::vector<std::string>& problems) {
  InputTopics topics;
  for (const InputName& input : kInputs) {
    const auto given = parameters.find(input.key);
    if (given == parameters.end()) continue;
    const Parameter& parameter = given->second;
    topics.*input.topic = asText(parameter.value).value_or("");
    if ((topics.*input.topic).empty())
      problems.push_back(std::string(input.key) + ": " + describe(parameter.value) + ", must be the name of a topic" +
                         (parameter.origin.empty() ? "" : " (" + parameter.origin + ")"));
    parameters.erase(given);
  }
  return topics;
}

std::string yamlOf(const InputTopics& topics) {
  std::string yaml;
  for (const InputName& input : kInputs) {
    const std::string& topic = topics.*input.topic;
    if (!topic.empty()) yaml += std::string(input.key) + ": " + quotedText(topic) + "\n";
  }
  return yaml;
}

}  // namespace hammer_loads
