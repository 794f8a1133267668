#include "hammer_loads/settings/parameter_reader.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

std::string ruleText(const NumberRule& rule) {
  const bool bounded = std::isfinite(rule.most);
  if (!bounded && !std::isfinite(rule.least)) return "a finite number";
  if (!bounded) return rule.above_least ? "a finite number > 0" : "a finite number >= 0";
  return (rule.or_zero ? "0 or a number in [" : "a number in [") + numberText(rule.least) + ", " +
         numberText(rule.most) + "]";
}

bool obeys(const NumberRule& rule, double value) {
  if (!std::isfinite(value)) return false;
  if (rule.or_zero && value == 0.0) return true;
  return value >= rule.least && value <= rule.most && !(rule.above_least && value == rule.least);
}

std::string withUnit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + " " + unit;
}

/// Returns texts in brackets, as a list of YAML.
template <typename T, typename TextOf>
std::string listText(const std::vector<T>& items, const TextOf& textOf) {
  std::string list;
  for (const T& item : items) list += (list.empty() ? "" : ", ") + textOf(item);
  return "[" + list + "]";
}

/// Returns the number of letters to insert, delete or replace to turn one word into the other (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

bool ParameterReader::given(const std::string& key) {
  known_.insert(key);
  return parameters_.count(key) != 0;
}

template <typename Convert, typename TextOf>
auto ParameterReader::read(const std::string& key, const std::string& unit, const std::string& rule,
                           const Convert& convert, const TextOf& textOf) -> decltype(convert(YAML::Node())) {
  known_.insert(key);
  const auto found = parameters_.find(key);
  if (found == parameters_.end()) {
    report(key, key + ": missing, must be " + rule + (unit.empty() ? "" : " in " + unit));
    return std::nullopt;
  }
  const YAML::Node& node = found->second.value;
  auto value = convert(node);
  if (value)
    yaml_ += key + ": " + textOf(*value) + "\n";
  else
    report(key, key + ": " + withUnit(describe(node), unit) + ", must be " + rule);
  return value;
}

double ParameterReader::number(const std::string& key, const std::string& unit, NumberRule rule) {
  const auto convert = [&](const YAML::Node& node) {
    const std::optional<double> value = asNumber(node);
    return value && obeys(rule, *value) ? value : std::nullopt;
  };
  return read(key, unit, ruleText(rule), convert, numberText).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::int64_t ParameterReader::integer(const std::string& key, const std::string& unit, std::int64_t least,
                                      std::int64_t most) {
  const auto convert = [&](const YAML::Node& node) {
    const std::optional<std::int64_t> value = asInteger(node);
    return value && *value >= least && *value <= most ? value : std::nullopt;
  };
  const std::string rule = "an integer in [" + std::to_string(least) + ", " + std::to_string(most) + "]";
  return read(key, unit, rule, convert, [](std::int64_t value) { return std::to_string(value); }).value_or(0);
}

bool ParameterReader::boolean(const std::string& key) {
  const auto text = [](bool value) { return value ? "true" : "false"; };
  return read(key, "", "true or false", asBoolean, text).value_or(false);
}

std::string ParameterReader::text(const std::string& key) {
  const auto convert = [](const YAML::Node& node) {
    const std::optional<std::string> value = asText(node);
    return value && !value->empty() ? value : std::nullopt;
  };
  return read(key, "", "a text, not empty", convert, quotedText).value_or("");
}

std::vector<std::string> ParameterReader::names(const std::string& key) {
  std::set<std::string> different;
  const auto convert = [&](const YAML::Node& node) {
    const std::optional<std::vector<std::string>> texts = asTexts(node);
    if (texts) different.insert(texts->begin(), texts->end());
    return texts && different.size() == texts->size() && different.count("") == 0 ? texts : std::nullopt;
  };
  const auto text = [](const std::vector<std::string>& texts) { return listText(texts, quotedText); };
  const auto names = read(key, "", "a list of different names", convert, text);
  return names ? *names : std::vector<std::string>(different.begin(), different.end());
}

std::vector<int> ParameterReader::signs(const std::string& key) {
  const auto convert = [](const YAML::Node& node) -> std::optional<std::vector<int>> {
    if (!node.IsSequence()) return std::nullopt;
    std::vector<int> signs;
    for (const YAML::Node& item : node) {
      const std::optional<std::int64_t> sign = asInteger(item);
      if (sign != 1 && sign != -1) return std::nullopt;
      signs.push_back(static_cast<int>(*sign));
    }
    return signs;
  };
  const auto text = [](const std::vector<int>& signs) {
    return listText(signs, [](int sign) { return std::to_string(sign); });
  };
  return read(key, "", "a list of 1 and -1", convert, text).value_or(std::vector<int>());
}

std::size_t ParameterReader::choiceIndex(const std::string& key, const std::vector<std::string>& words) {
  std::string rule;
  for (const std::string& word : words) rule += (rule.empty() ? "one of " : ", ") + word;
  const auto convert = [&](const YAML::Node& node) -> std::optional<std::size_t> {
    const auto found = std::find(words.begin(), words.end(), asText(node).value_or(""));
    if (found == words.end()) return std::nullopt;
    return static_cast<std::size_t>(found - words.begin());
  };
  return read(key, "", rule, convert, [&](std::size_t index) { return quotedText(words[index]); }).value_or(0);
}

void ParameterReader::report(const std::string& key, const std::string& line) {
  const auto found = parameters_.find(key);
  const std::string origin = found == parameters_.end() ? std::string{} : found->second.origin;
  problems_.push_back(line + (origin.empty() ? "" : " (" + origin + ")"));
  faulty_.insert(key);
}

void ParameterReader::demand(const std::string& key, const std::string& unit, double value, NumberRule rule) {
  if (obeys(rule, value)) return;
  addProblem(key + ": " + withUnit(numberText(value), unit) + ", must be " + ruleText(rule));
}

void ParameterReader::addProblem(const std::string& line) {
  const std::string key = line.substr(0, line.find(':'));
  if (known_.count(key) == 0 || faulty_.count(key) == 0) report(key, line);
}

void ParameterReader::reportUnknownKeys() {
  for (const auto& [key, parameter] : parameters_) {
    if (known_.count(key) != 0) continue;
    const std::string hint = nearestKnownKey(key);
    report(key, onOneLine(key) + ": unknown key" + (hint.empty() ? "" : ", perhaps " + hint + " was meant"));
  }
}

std::string ParameterReader::nearestKnownKey(const std::string& key) const {
  std::string nearest;
  std::size_t least = 1 + std::max<std::size_t>(2, key.size() / 4);  // a larger distance is no misspelling
  for (const std::string& known : known_) {
    const auto [shorter, longer] = std::minmax({key.size(), known.size()});
    if (longer - shorter >= least) continue;  // cannot be nearer; saves most of the time of a file of foreign keys
    const std::size_t distance = editDistance(key, known);
    if (distance < least) {
      least = distance;
      nearest = known;
    }
  }
  return nearest;
}

}  // namespace hammer_loads
