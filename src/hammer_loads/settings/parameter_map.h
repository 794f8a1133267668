/// Parameters as given, before they are checked: key, value and origin of each.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Largest file or recorded text [byte]. The longest shipped file has 8 kB; one of this size takes about 1 s.
constexpr std::size_t kMostParameterBytes = 1000 * 1000;

struct Parameter {
  YAML::Node value;
  std::string origin;  ///< "hammer.yaml:3", a namespace, or empty if unknown
};

using ParameterMap = std::map<std::string, Parameter>;

/// Returns the top-level keys of a map, or nothing if `node` is no map. A repeated key and a key that is no text are
/// reported, one line each, beginning with `origin`. The first value of a repeated key counts.
std::optional<ParameterMap> parameterMap(const YAML::Node& node, const std::string& origin,
                                         std::vector<std::string>& problems);

/// Reads a YAML file. Returns nothing, with one line on the reason, if it cannot be read, is not YAML, or holds no map
/// or several documents.
std::optional<ParameterMap> readParameterFile(const std::string& file, std::vector<std::string>& problems);

/// Adds `over` to `base`; a key of both takes the value of `over`.
void merge(const ParameterMap& over, ParameterMap& base);

/// Adds the files' keys to `parameters`, in order. Returns false if a file could not be read at all.
bool addFiles(const std::vector<std::string>& files, ParameterMap& parameters, std::vector<std::string>& problems);

/// Returns the result with `problems` before its own; without a value if there are any.
template <typename T>
Checked<T> behind(const std::vector<std::string>& problems, Checked<T> result) {
  result.problems.insert(result.problems.begin(), problems.begin(), problems.end());
  if (!result.problems.empty()) result.value.reset();
  return result;
}

/// Returns the result of load(parameters) for the files' parameters, with the problems of the files first. If a file
/// cannot be read at all, load is not called, since the file's keys would be reported as missing.
template <typename Load>
auto loadFrom(const std::vector<std::string>& files, const Load& load) -> decltype(load(ParameterMap())) {
  std::vector<std::string> problems;
  ParameterMap parameters;
  decltype(load(ParameterMap())) result;
  if (addFiles(files, parameters, problems)) result = load(std::move(parameters));
  return behind(problems, std::move(result));
}

}  // namespace hammer_loads
