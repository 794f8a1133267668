#include "hammer_loads/settings/parameter_texts.h"

#include "hammer_loads/settings/input_topics.h"
#include "hammer_loads/settings/parameter_map.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

std::string textOf(const YAML::Node& value) {
  if (const auto number = asNumber(value)) return numberText(*number);
  if (const auto boolean = asBoolean(value)) return *boolean ? "true" : "false";
  if (value.IsScalar()) return value.Scalar();
  std::string text;
  for (const YAML::Node& item : value) text += (text.empty() ? "" : ", ") + textOf(item);
  return "[" + text + "]";
}

ParameterMap shippedIn(const std::string& directory, const std::vector<const char*>& files) {
  std::vector<std::string> paths, problems;
  for (const char* file : files) paths.push_back(directory + "/" + file);
  ParameterMap parameters;
  addFiles(paths, parameters, problems);
  return parameters;
}

}  // namespace

std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml) {
  std::vector<std::string> problems;
  ParameterMap parameters = parameterMap(YAML::Load(yaml), {}, problems).value_or(ParameterMap{});
  takeInputTopics(parameters, problems);  // names of a recording, no parameters
  const ParameterMap shipped =
      shippedIn(config_directory, {"pipeline.yaml", "log.yaml", "life.yaml", "hammer_mo100.yaml", "boom_eo2621.yaml"});
  std::vector<ParameterText> texts;
  for (const auto& [key, parameter] : parameters) {
    const auto found = shipped.find(key);
    texts.push_back({key, textOf(parameter.value),
                     found == shipped.end() ? std::nullopt : std::make_optional(textOf(found->second.value))});
  }
  return texts;
}

}  // namespace hammer_loads
