#include "hammer_loads/settings/yaml_value.h"

#include <boost/lexical_cast/try_lexical_convert.hpp>
#include <cmath>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Returns true for a scalar without quotes: its meaning depends on its characters.
bool isPlain(const YAML::Node& value) {
  if (!value.IsScalar()) return false;
  const std::string& tag = value.Tag();
  return tag.empty() || tag == "?" || tag == "tag:yaml.org,2002:float" || tag == "tag:yaml.org,2002:int" ||
         tag == "tag:yaml.org,2002:bool";
}

}  // namespace

std::optional<double> asNumber(const YAML::Node& value) {
  if (!isPlain(value)) return std::nullopt;
  if (const auto number = decimalNumber(value.Scalar())) return number;
  double special = 0.0;  // .inf, -.inf, .nan: yaml-cpp also accepts other spellings of finite numbers
  if (!YAML::convert<double>::decode(value, special) || std::isfinite(special)) return std::nullopt;
  return special;
}

std::optional<std::int64_t> asInteger(const YAML::Node& value) {
  std::int64_t number = 0;
  if (!isPlain(value) || !boost::conversion::try_lexical_convert(value.Scalar(), number)) return std::nullopt;
  return number;
}

std::optional<bool> asBoolean(const YAML::Node& value) {
  bool answer = false;
  if (!isPlain(value) || !YAML::convert<bool>::decode(value, answer)) return std::nullopt;
  return answer;
}

std::optional<std::string> asText(const YAML::Node& value) {
  if (!value.IsScalar()) return std::nullopt;
  const bool means_something_else = isPlain(value) && (value.Scalar().empty() || asNumber(value) || asBoolean(value));
  if (means_something_else) return std::nullopt;
  return value.Scalar();
}

std::optional<std::vector<std::string>> asTexts(const YAML::Node& value) {
  if (!value.IsSequence()) return std::nullopt;
  std::vector<std::string> texts;
  for (const YAML::Node& item : value) {
    const std::optional<std::string> text = asText(item);
    if (!text) return std::nullopt;
    texts.push_back(*text);
  }
  return texts;
}

YAML::Node textNode(const std::string& text) {
  YAML::Node node(text);
  node.SetTag("!");
  return node;
}

std::string numberText(double value) {
  std::string text = shortNumber(value);
  if (text.find_first_of(".n") == std::string::npos) {  // n: inf, nan
    const std::size_t exponent = text.find('e');
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

std::string quotedText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += format("\\x%02x", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string describe(const YAML::Node& value) {
  if (!value.IsDefined() || value.IsNull()) return "(empty)";
  if (value.IsSequence()) return "(a list)";
  if (value.IsMap()) return "(a map)";
  constexpr std::size_t kLongest = 60;
  std::string text = value.Scalar();
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return isPlain(value) ? onOneLine(text) : quotedText(text);
}

}  // namespace hammer_loads
