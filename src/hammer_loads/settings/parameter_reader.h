/// Reader of typed parameters that collects all their problems.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

/// Bounds of a number. NaN and infinity are never allowed.
struct NumberRule {
  double least{-std::numeric_limits<double>::infinity()}, most{std::numeric_limits<double>::infinity()};  ///< inclusive
  bool above_least{};  ///< `least` itself is excluded
  bool or_zero{};      ///< 0, for none, is allowed as well

  static constexpr NumberRule any() { return {}; }
  static constexpr NumberRule positive() { return {0.0, any().most, true, false}; }
  static constexpr NumberRule notNegative() { return {0.0, any().most, false, false}; }
  static constexpr NumberRule within(double least, double most) { return {least, most, false, false}; }
  static constexpr NumberRule zeroOrWithin(double least, double most) { return {least, most, false, true}; }
};

/// Word of a choice and its meaning.
template <typename T>
using Named = std::pair<const char*, T>;

/// Reader whose values are usable only if problems() stays empty; otherwise they are NaN, 0, false, "" or the first
/// choice. Nothing throws for bad content. A problem is one line: `KEY: VALUE UNIT, must be RULE (FILE:LINE)`.
class ParameterReader {
 public:
  explicit ParameterReader(ParameterMap parameters) : parameters_(std::move(parameters)) {}

  /// Returns true if an optional parameter is given; the key is then known.
  bool given(const std::string& key);
  /// Returns a number in the parameter's unit, which only reports use; "" for none. An integer literal is accepted.
  double number(const std::string& key, const std::string& unit, NumberRule rule);
  /// Returns an integer in [least, most].
  std::int64_t integer(const std::string& key, const std::string& unit, std::int64_t least, std::int64_t most);
  bool boolean(const std::string& key);
  /// Returns a text that is not empty.
  std::string text(const std::string& key);
  /// Returns a list of texts, each not empty and given once; it may be empty. After a problem, it has the list's
  /// different texts, so that keys named after them are not unknown.
  std::vector<std::string> names(const std::string& key);
  /// Returns a list of 1 and -1, which may be empty.
  std::vector<int> signs(const std::string& key);
  /// Returns the meaning of one of several words.
  template <typename T, std::size_t N>
  T choice(const std::string& key, const std::array<Named<T>, N>& choices) {
    std::vector<std::string> words;
    for (const auto& [word, meaning] : choices) words.emplace_back(word);
    return choices[choiceIndex(key, words)].second;
  }

  /// Checks a number again that was read under another rule; adds a problem unless the key has one already.
  void demand(const std::string& key, const std::string& unit, double value, NumberRule rule);
  /// Adds a problem `KEY: ...` that concerns several keys, with the origin of KEY, unless KEY has a problem already.
  void addProblem(const std::string& line);
  /// Reports each key that was not read, with the nearest known one. Must be called after all reads.
  void reportUnknownKeys();

  const std::vector<std::string>& problems() const { return problems_; }
  /// Returns every valid parameter so far, in the order of reading, one `key: value` a line. Numbers have as many of 17
  /// digits as are needed to read back the same value; texts are in quotes.
  const std::string& yaml() const { return yaml_; }

 private:
  /// Returns the key's value as convert(node) gives it, kept for yaml() as textOf(value) writes it. Returns nothing,
  /// with a problem, if the key is missing or convert() returns nothing.
  template <typename Convert, typename TextOf>
  auto read(const std::string& key, const std::string& unit, const std::string& rule, const Convert& convert,
            const TextOf& textOf) -> decltype(convert(YAML::Node()));
  void report(const std::string& key, const std::string& line);
  std::size_t choiceIndex(const std::string& key, const std::vector<std::string>& words);
  std::string nearestKnownKey(const std::string& key) const;

  ParameterMap parameters_;
  std::set<std::string> known_;   ///< requested keys
  std::set<std::string> faulty_;  ///< keys with a problem
  std::vector<std::string> problems_;
  std::string yaml_;
};

}  // namespace hammer_loads
