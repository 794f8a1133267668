#include "hammer_loads/settings/parameter_reader.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

std::string ruleText(NumberRule rule) {
  switch (rule.kind) {
    case NumberRule::Kind::kAny:
      return "a finite number";
    case NumberRule::Kind::kPositive:
      return "a finite number > 0";
    case NumberRule::Kind::kNotNegative:
      return "a finite number >= 0";
    case NumberRule::Kind::kZeroOrWithin:
      return "0 or a number in [" + numberText(rule.least) + ", " + numberText(rule.most) + "]";
    case NumberRule::Kind::kWithin:
      break;
  }
  return "a number in [" + numberText(rule.least) + ", " + numberText(rule.most) + "]";
}

bool obeys(NumberRule rule, double value) {
  if (!std::isfinite(value)) return false;
  switch (rule.kind) {
    case NumberRule::Kind::kAny:
      return true;
    case NumberRule::Kind::kPositive:
      return value > 0.0;
    case NumberRule::Kind::kNotNegative:
      return value >= 0.0;
    case NumberRule::Kind::kZeroOrWithin:
      if (value == 0.0) return true;
      break;
    case NumberRule::Kind::kWithin:
      break;
  }
  return value >= rule.least && value <= rule.most;
}

/// Letters to insert, delete or replace to turn one word into the other (Levenshtein).
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

bool areNames(const std::vector<std::string>& texts) {
  std::set<std::string> seen;
  for (const std::string& text : texts) {
    if (text.empty() || !seen.insert(text).second) return false;
  }
  return true;
}

}  // namespace

bool ParameterReader::given(const std::string& key) {
  known_.insert(key);
  return parameters_.count(key) != 0;
}

double ParameterReader::number(const std::string& key, const std::string& unit, NumberRule rule) {
  const Parameter* parameter = find(key, unit, ruleText(rule));
  if (parameter == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = asNumber(parameter->value);
  if (!value || !obeys(rule, *value)) {
    refuse(key, *parameter, unit, ruleText(rule));
    return std::numeric_limits<double>::quiet_NaN();
  }
  keep(key, numberText(*value));
  return *value;
}

std::int64_t ParameterReader::integer(const std::string& key, const std::string& unit, std::int64_t least,
                                      std::int64_t most) {
  const std::string rule = "an integer in [" + std::to_string(least) + ", " + std::to_string(most) + "]";
  const Parameter* parameter = find(key, unit, rule);
  if (parameter == nullptr) return 0;
  const std::optional<std::int64_t> value = asInteger(parameter->value);
  if (!value || *value < least || *value > most) {
    refuse(key, *parameter, unit, rule);
    return 0;
  }
  keep(key, std::to_string(*value));
  return *value;
}

bool ParameterReader::boolean(const std::string& key) {
  const std::string rule = "true or false";
  const Parameter* parameter = find(key, "", rule);
  if (parameter == nullptr) return false;
  const std::optional<bool> value = asBoolean(parameter->value);
  if (!value) {
    refuse(key, *parameter, "", rule);
    return false;
  }
  keep(key, *value ? "true" : "false");
  return *value;
}

std::string ParameterReader::text(const std::string& key) {
  const std::string rule = "a text, not empty";
  const Parameter* parameter = find(key, "", rule);
  if (parameter == nullptr) return {};
  const std::optional<std::string> value = asText(parameter->value);
  if (!value || value->empty()) {
    refuse(key, *parameter, "", rule);
    return {};
  }
  keep(key, quotedText(*value));
  return *value;
}

std::vector<std::string> ParameterReader::names(const std::string& key) {
  const std::string rule = "a list of different names";
  const Parameter* parameter = find(key, "", rule);
  if (parameter == nullptr) return {};
  const std::optional<std::vector<std::string>> value = asTexts(parameter->value);
  if (!value || !areNames(*value)) {
    refuse(key, *parameter, "", rule);
    if (!value) return {};
    const std::set<std::string> different(value->begin(), value->end());
    return {different.begin(), different.end()};
  }
  std::string list;
  for (const std::string& name : *value) list += (list.empty() ? "" : ", ") + quotedText(name);
  keep(key, "[" + list + "]");
  return *value;
}

std::vector<int> ParameterReader::signs(const std::string& key) {
  const std::string rule = "a list of 1 and -1";
  const Parameter* parameter = find(key, "", rule);
  if (parameter == nullptr) return {};
  std::vector<int> result;
  std::string list;
  bool good = parameter->value.IsSequence();
  for (std::size_t i = 0; good && i < parameter->value.size(); ++i) {
    const std::optional<std::int64_t> sign = asInteger(parameter->value[i]);
    good = sign && (*sign == 1 || *sign == -1);
    if (!good) break;
    result.push_back(static_cast<int>(*sign));
    list += (list.empty() ? "" : ", ") + std::to_string(*sign);
  }
  if (!good) {
    refuse(key, *parameter, "", rule);
    return {};
  }
  keep(key, "[" + list + "]");
  return result;
}

std::size_t ParameterReader::choiceIndex(const std::string& key, const std::vector<std::string>& words) {
  std::string rule;
  for (const std::string& word : words) rule += (rule.empty() ? "one of " : ", ") + word;
  const Parameter* parameter = find(key, "", rule);
  if (parameter == nullptr) return 0;
  const std::optional<std::string> value = asText(parameter->value);
  const auto found = value ? std::find(words.begin(), words.end(), *value) : words.end();
  if (found == words.end()) {
    refuse(key, *parameter, "", rule);
    return 0;
  }
  keep(key, quotedText(*value));
  return static_cast<std::size_t>(found - words.begin());
}

const Parameter* ParameterReader::find(const std::string& key, const std::string& unit, const std::string& rule) {
  known_.insert(key);
  const auto found = parameters_.find(key);
  if (found != parameters_.end()) return &found->second;
  report(key, key + ": missing, must be " + rule + (unit.empty() ? "" : " in " + unit));
  return nullptr;
}

void ParameterReader::refuse(const std::string& key, const Parameter& parameter, const std::string& unit,
                             const std::string& rule) {
  report(key, key + ": " + describe(parameter.value) + (unit.empty() ? "" : " " + unit) + ", must be " + rule);
}

void ParameterReader::report(const std::string& key, const std::string& line) {
  const auto found = parameters_.find(key);
  const std::string origin = found == parameters_.end() ? std::string{} : found->second.origin;
  problems_.push_back(line + (origin.empty() ? "" : " (" + origin + ")"));
  faulty_.insert(key);
}

void ParameterReader::demand(const std::string& key, const std::string& unit, double value, NumberRule rule) {
  if (obeys(rule, value)) return;
  addProblem(key + ": " + numberText(value) + (unit.empty() ? "" : " " + unit) + ", must be " + ruleText(rule));
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
    if (longer - shorter >= least) continue;  // no nearer than that; saves most of the time of a file of foreign keys
    const std::size_t distance = editDistance(key, known);
    if (distance < least) {
      least = distance;
      nearest = known;
    }
  }
  return nearest;
}

}  // namespace hammer_loads
