#include "hammer_loads/settings/parameter_map.h"

#include <cctype>
#include <sstream>

#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/file_text.h"

namespace hammer_loads {
namespace {

std::string at(const std::string& origin, const YAML::Mark& mark) {
  return mark.is_null() ? origin : origin + ":" + std::to_string(mark.line + 1);
}

/// Counts documents by their marks. From some texts that are no YAML, yaml-cpp 0.7 reads documents without end.
int countDocuments(const std::string& text) {
  int count = 0;
  bool open = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    const bool is_mark = line.size() <= 3 || std::isspace(static_cast<unsigned char>(line[3])) != 0;
    const bool begins = is_mark && line.rfind("---", 0) == 0, ends = is_mark && line.rfind("...", 0) == 0;
    const bool has_content = first != std::string::npos && line[first] != '#' && line[0] != '%' && !ends;
    if (begins || (has_content && !open)) ++count;
    open = (open || has_content) && !ends;
  }
  return count;
}

}  // namespace

std::optional<ParameterMap> parameterMap(const YAML::Node& node, const std::string& origin,
                                         std::vector<std::string>& problems) {
  if (!node.IsMap()) {
    problems.push_back(origin + ": " + describe(node) + ", must be a map of keys to values");
    return std::nullopt;
  }
  ParameterMap map;
  for (const auto& pair : node) {
    const std::string place = at(origin, pair.first.Mark());
    if (!pair.first.IsScalar()) {
      problems.push_back(place + ": " + describe(pair.first) + " as a key, must be a text");
      continue;
    }
    const std::string& key = pair.first.Scalar();
    const auto [known, added] = map.emplace(key, Parameter{pair.second, place});
    if (!added) {
      const std::string places = known->second.origin + ", " + place;
      problems.push_back(onOneLine(key) + ": given twice, must be given once (" + places + ")");
    }
  }
  return map;
}

std::optional<ParameterMap> readParameterFile(const std::string& file, std::vector<std::string>& problems) {
  const Checked<std::string> text = fileText(file, kMostParameterBytes, "a file of parameters");
  problems.insert(problems.end(), text.problems.begin(), text.problems.end());
  if (!text.value) return std::nullopt;
  try {
    const int documents = countDocuments(*text.value);
    if (documents == 1) return parameterMap(YAML::Load(*text.value), file, problems);
    problems.push_back(file + ": " + std::to_string(documents) + " YAML documents, must be one");
  } catch (const YAML::Exception& error) {
    problems.push_back(at(file, error.mark) + ": not valid YAML: " + onOneLine(error.msg));
  }
  return std::nullopt;
}

/// Inserts all anew: an assignment to a node changes every copy of it, and the documents of both are never released.
void merge(const ParameterMap& over, ParameterMap& base) {
  ParameterMap all = over;
  all.insert(base.begin(), base.end());
  base.swap(all);
}

bool addFiles(const std::vector<std::string>& files, ParameterMap& parameters, std::vector<std::string>& problems) {
  bool all_read = true;
  for (const std::string& file : files) {
    const std::optional<ParameterMap> read = readParameterFile(file, problems);
    if (read) merge(*read, parameters);
    all_read = all_read && read.has_value();
  }
  return all_read;
}

}  // namespace hammer_loads
