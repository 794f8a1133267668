#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

constexpr char kUnknownKey[] = ": unknown key";

/// Removes the keys that the problems report as unknown. Returns true if there were any.
bool dropUnknown(const std::vector<std::string>& problems, ParameterMap& parameters, std::vector<std::string>& notes) {
  bool dropped = false;
  for (const std::string& problem : problems) {
    const std::size_t end = problem.find(kUnknownKey);
    const auto found = end == std::string::npos ? parameters.end() : parameters.find(problem.substr(0, end));
    if (found == parameters.end()) continue;
    notes.push_back(found->first + ": " + describe(found->second.value) + ", not known to this version, is ignored");
    parameters.erase(found);
    dropped = true;
  }
  return dropped;
}

std::string textOf(const YAML::Node& value) {
  if (const auto number = asNumber(value)) return numberText(*number);
  if (const auto boolean = asBoolean(value)) return *boolean ? "true" : "false";
  if (value.IsScalar()) return value.Scalar();
  std::string text;
  for (const YAML::Node& item : value) text += (text.empty() ? "" : ", ") + textOf(item);
  return "[" + text + "]";
}

}  // namespace

std::optional<ParameterMap> recordedParameters(const std::string& parameters_yaml, std::vector<std::string>& problems) {
  if (parameters_yaml.size() > kMostParameterBytes) {
    problems.push_back("run_info: more than " + std::to_string(kMostParameterBytes) + " bytes, must be parameters");
    return std::nullopt;
  }
  try {
    return parameterMap(YAML::Load(parameters_yaml), "run_info", problems);
  } catch (const YAML::Exception& error) {
    problems.push_back("run_info: not valid YAML: " + onOneLine(error.msg));
    return std::nullopt;
  }
}

Checked<Settings> loadRecorded(const std::string& config_directory, const std::string& parameters_yaml,
                               const std::string& robot_description) {
  Checked<Settings> result;
  std::optional<ParameterMap> given = recordedParameters(parameters_yaml, result.problems);
  if (!given || !result.problems.empty()) return result;
  result = load(config_directory, *given, robot_description);
  std::vector<std::string> notes;
  if (dropUnknown(result.problems, *given, notes)) result = load(config_directory, *given, robot_description);
  if (!result.value) return result;
  std::vector<std::string> ignored;
  const std::optional<ParameterMap> in_force = recordedParameters(result.value->yaml, ignored);
  for (const auto& [key, parameter] : in_force.value_or(ParameterMap{})) {
    if (given->count(key) == 0)
      notes.push_back(key + ": not recorded, the shipped value is used: " + describe(parameter.value));
  }
  result.notes = std::move(notes);
  return result;
}

std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml) {
  std::vector<std::string> problems;
  ParameterMap parameters = parameterMap(YAML::Load(yaml), {}, problems).value_or(ParameterMap{});
  for (const InputName& input : kInputs) parameters.erase(input.key);  // topics of a recording, no parameters
  std::vector<std::string> files;
  for (const char* name : {"pipeline", "log", "life", "hammer_mo100", "boom_eo2621"})
    files.push_back(config_directory + "/" + name + ".yaml");
  ParameterMap shipped;
  addFiles(files, shipped, problems);
  std::vector<ParameterText> texts;
  for (const auto& [key, parameter] : parameters) {
    const auto found = shipped.find(key);
    texts.push_back({key, textOf(parameter.value),
                     found == shipped.end() ? std::nullopt : std::make_optional(textOf(found->second.value))});
  }
  return texts;
}

}  // namespace hammer_loads
