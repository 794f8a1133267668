/// Settings from an input's bytes: every number of the shipped files, anywhere within what the reader accepts.
#pragma once

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/bytes.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads::test {

inline const Settings& shippedSettings() {
  static const Settings settings = *loadFiles(configDirectory(), {}).value;
  return settings;
}

using Numbers = std::map<std::string, double>;

/// Returns the shipped settings with these numbers and words replaced.
inline Checked<Settings> settingsWith(const Numbers& numbers, const std::map<std::string, std::string>& words = {}) {
  std::vector<std::string> problems;
  static const ParameterMap shipped = parameterMap(YAML::Load(shippedSettings().yaml), {}, problems).value();
  ParameterMap given = shipped;
  for (const auto& [key, number] : numbers) {
    const bool whole = asInteger(shipped.at(key).value).has_value();
    given.erase(key);  // nodes share what is assigned to them: a new one instead
    given.emplace(
        key, Parameter{YAML::Node(whole ? std::to_string(static_cast<long long>(number)) : numberText(number)), {}});
  }
  for (const auto& [key, word] : words) {
    given.erase(key);
    given.emplace(key, Parameter{YAML::Node(word), {}});
  }
  return load(configDirectory(), given);
}

/// A number among the settings and the bounds that its error message states.
struct NumberKey {
  std::string name;
  double least{}, most{};
  bool or_zero{};
};

/// Reads the bounds from the message `... must be [0 or] a number in [LEAST, MOST] ...`.
inline std::optional<NumberKey> boundsIn(const std::string& key, const std::string& line) {
  const std::size_t at = line.find("in [");
  if (line.rfind(key + ":", 0) != 0 || at == std::string::npos) return std::nullopt;
  char* comma = nullptr;
  const double least = std::strtod(line.c_str() + at + 4, &comma);
  return NumberKey{key, least, std::strtod(comma + 1, nullptr), line.find("must be 0 or") != std::string::npos};
}

/// Returns every key with a numeric value. Each must have bounds, otherwise a typing error would be accepted.
inline const std::vector<NumberKey>& numberKeys() {
  static const std::vector<NumberKey> all = [] {
    std::vector<NumberKey> keys;
    for (const auto& pair : YAML::Load(shippedSettings().yaml)) {
      if (!asNumber(pair.second)) continue;
      const std::string key = pair.first.as<std::string>();
      std::optional<NumberKey> found;
      for (const double beyond : {1e18, 2e8}) {  // the mechanism's own bounds are wider
        if (found) break;
        for (const std::string& line : settingsWith({{key, beyond}}).problems)
          if (!found) found = boundsIn(key, line);
      }
      // For these keys a message about a relation between keys comes first.
      if (!found && key.find("_length_m") != std::string::npos) found = NumberKey{key, 1e-3, 10.0, false};
      if (!found && key == "pivot_distance_m") found = NumberKey{key, 1e-3, 10.0, false};
      if (!found && key.rfind("crank_eccentricity_", 0) == 0) found = NumberKey{key, 0.0, 0.3, false};
      if (!found) {
        std::fprintf(stderr, "%s: has no bounds\n", key.c_str());
        for (const std::string& line : settingsWith({{key, 2e8}}).problems)
          std::fprintf(stderr, "  %s\n", line.c_str());
      }
      require(found.has_value());
      keys.push_back(*found);
    }
    return keys;
  }();
  return all;
}

/// Returns a value between the bounds, spaced logarithmically where they are not negative.
inline double between(const NumberKey& key, std::uint16_t place) {
  if (place == 0) return key.or_zero ? 0.0 : key.least;
  const double part = place / 65535.0;
  if (place == 65535) return key.most;
  if (key.least < 0.0) return key.least + part * (key.most - key.least);
  const double least = key.least > 0.0 ? key.least : 1e-9 * key.most;
  return std::clamp(least * std::pow(key.most / least, part), key.least, key.most);
}

/// Enforces relations between keys: change-point condition, inertia about the pivot, levers of the blow.
inline void makePossible(Numbers& n) {
  const YAML::Node shipped = YAML::Load(shippedSettings().yaml);
  const auto value = [&](const char* key) { return n.count(key) != 0 ? n[key] : shipped[key].as<double>(); };
  const double crank = value("crank_length_m");
  for (const char* key : {"pivot_distance_m", "rocker_length_m"}) n[key] = std::clamp(value(key), 1.01 * crank, 10.0);
  n["rod_length_m"] = std::min(value("pivot_distance_m") + value("rocker_length_m") - crank, 10.0);
  const double mass = value("rocker_mass_kg"), com = value("rocker_com_distance_m");
  n["rocker_inertia_about_pivot_kg_m2"] = std::max(value("rocker_inertia_about_pivot_kg_m2"), 1.01 * mass * com * com);
  const double gyration = std::sqrt(n["rocker_inertia_about_pivot_kg_m2"] / mass);
  n["striking_distance_m"] = std::clamp(value("striking_distance_m"), 0.11 * gyration, 9.0 * gyration);
  const double most = 0.9 * n["striking_distance_m"] / std::max(value("striking_friction"), 0.01);
  n["striking_offset_m"] = std::clamp(value("striking_offset_m"), -std::min(most, 10.0), std::min(most, 10.0));
}

/// Reads the words, the number of changes and each change. Returns nothing if the reader rejects the result.
inline std::optional<Settings> drawnSettings(Bytes& bytes) {
  const auto choice = bytes.take<std::uint8_t>(), changes = bytes.take<std::uint8_t>();
  std::map<std::string, std::string> words;
  words["level"] = std::vector<const char*>{"pulse", "rocker", "linkage", "auto"}[choice % 4];
  words["output"] = choice / 4 % 2 == 0 ? "instantaneous" : "mean";
  words["crank_stamps"] = std::vector<const char*>{"auto", "header", "steady", "auto"}[choice / 8 % 4];
  Numbers numbers;
  for (int i = 0; i < changes && !bytes.empty(); ++i) {
    const NumberKey& key = numberKeys()[bytes.take<std::uint8_t>() % numberKeys().size()];
    numbers[key.name] = between(key, bytes.take<std::uint16_t>());
  }
  makePossible(numbers);
  return settingsWith(numbers, words).value;
}

}  // namespace hammer_loads::test
