/// Strict interpretation of a single YAML value: a quoted number is a text, a text is not a number.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/util/number_text.h"

namespace hammer_loads {

/// Returns a decimal number, an integer literal, .nan or .inf; nothing for any other value.
std::optional<double> asNumber(const YAML::Node& value);
/// Returns a decimal integer without point or exponent.
std::optional<std::int64_t> asInteger(const YAML::Node& value);
/// Returns the value of true/false, yes/no or on/off.
std::optional<bool> asBoolean(const YAML::Node& value);
/// Returns a quoted text, or a plain one that is neither number nor boolean nor empty.
std::optional<std::string> asText(const YAML::Node& value);
/// Returns the texts of a list whose items are all texts; an empty list is one.
std::optional<std::vector<std::string>> asTexts(const YAML::Node& value);

/// Makes a node that every reader, YAML 1.1 or 1.2, takes for a text.
YAML::Node textNode(const std::string& text);

/// Returns the shortest number of at most 17 significant digits that reads back as the same double, with a decimal
/// point (YAML 1.1 takes 5e-4 for a text).
std::string numberText(double value);
/// Returns the text in double quotes, escaped: valid YAML on one line.
std::string quotedText(const std::string& text);
/// Returns the text of a value for a report: on one line, shortened if long.
std::string describe(const YAML::Node& value);

}  // namespace hammer_loads
