/// Options of a command. The library behind them (CLI11) is compiled once, not with every command.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hammer_loads {

/// One option. Each function returns the option, so that calls can be chained. It lives as long as its CommandLine.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option type(const std::string& name);                               ///< type of its value, in the help
  Option description(const std::string& text);                        ///< instead of the first one
  Option showDefault();                                               ///< the value that the variable has now
  Option showDefault(const std::string& text);                        ///< in these words
  Option values(int least, int most);                                 ///< number of values
  Option oneEachTime();                                               ///< may be repeated, with one value each time
  Option within(double least, double most, const std::string& unit);  ///< finite; least is excluded when it is 0
  Option withinIntegers(std::int64_t least, std::int64_t most);
  Option oneOf(const std::vector<std::string>& words);
  Option excludes(const std::vector<std::string>& others);
  Option needs(const std::string& other);

  /// After parsing: whether the user gave it.
  bool given() const;

 private:
  CLI::Option* option_;
};

class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& name, const std::string& footer = {});
  ~CommandLine();

  /// `value` keeps what it holds unless the option is given. T: std::string, double, std::optional<double>, int,
  /// std::int64_t, std::vector<std::string>, std::vector<double>.
  template <typename T>
  Option option(const std::string& name, T& value, const std::string& help = {});
  /// Passes the given value to `take`.
  Option call(const std::string& name, const std::function<void(const std::string&)>& take, const std::string& help);
  Option flag(const std::string& name, bool& value, const std::string& help);
  /// One that was added before.
  Option operator[](const std::string& name);

  /// Empty if the command may continue, otherwise the exit code (0 after --help).
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace hammer_loads
