/// A single YAML value, judged strictly: a quoted number is a text, a text is not a number.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/util/number_text.h"

namespace hammer_loads {

/// Decimal number, integer literals included; .nan and .inf count as numbers. Nothing else does.
std::optional<double> asNumber(const YAML::Node& value);
/// Decimal integer without point or exponent.
std::optional<std::int64_t> asInteger(const YAML::Node& value);
/// true/false, yes/no, on/off.
std::optional<bool> asBoolean(const YAML::Node& value);
/// Quoted, or plain and neither number nor boolean nor empty.
std::optional<std::string> asText(const YAML::Node& value);
/// List whose items are all texts; an empty list is one.
std::optional<std::vector<std::string>> asTexts(const YAML::Node& value);

/// Text that every reader, YAML 1.1 or 1.2, takes for a text.
YAML::Node textNode(const std::string& text);

/// Shortest of at most 17 significant digits that reads back as the same double, with a decimal point (YAML 1.1 takes
/// 5e-4 for a text).
std::string numberText(double value);
/// In double quotes, escaped: valid YAML on one line.
std::string quotedText(const std::string& text);
/// Text of a value in a report: on one line, shortened when long.
std::string describe(const YAML::Node& value);

}  // namespace hammer_loads
