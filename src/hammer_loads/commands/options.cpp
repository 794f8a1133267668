#include "hammer_loads/commands/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string_view>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

std::string ruleText(double least, double most) {
  std::string rule = "a finite number";
  if (std::isfinite(least)) rule += (least == 0.0 ? " > " : " >= ") + numberText(least);
  if (std::isfinite(most)) rule += (std::isfinite(least) ? " and <= " : " <= ") + numberText(most);
  return rule;
}

}  // namespace

Option Option::required() { return Option(option_->required()); }
Option Option::type(const std::string& name) { return Option(option_->type_name(name)); }
Option Option::description(const std::string& text) { return Option(option_->description(text)); }
Option Option::showDefault() { return Option(option_->capture_default_str()); }
Option Option::showDefault(const std::string& text) { return Option(option_->default_str(text)); }
Option Option::values(int least, int most) { return Option(option_->expected(least, most)); }
Option Option::oneEachTime() { return Option(option_->allow_extra_args(false)); }

Option Option::within(double least, double most, const std::string& unit) {
  const auto rule = [=](std::string& text) {
    const std::optional<double> value = asNumber(YAML::Node(text));
    const bool positive = least != 0.0 || (value && *value > 0.0);
    const bool good = value && std::isfinite(*value) && *value >= least && *value <= most && positive;
    return good ? std::string{} : text + (unit.empty() ? "" : " " + unit) + ", must be " + ruleText(least, most);
  };
  return Option(option_->check(CLI::Validator(rule, "")));
}

Option Option::withinIntegers(std::int64_t least, std::int64_t most) {
  return Option(option_->check(CLI::Range(least, most)));
}
Option Option::oneOf(const std::vector<std::string>& words) { return Option(option_->check(CLI::IsMember(words))); }

Option Option::excludes(const std::vector<std::string>& others) {
  for (const std::string& other : others) option_->excludes(other);
  return *this;
}
Option Option::needs(const std::string& other) { return Option(option_->needs(other)); }
bool Option::given() const { return option_->count() > 0; }

CommandLine::CommandLine(const std::string& description, const std::string& name, const std::string& footer)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->footer(footer);
}
CommandLine::~CommandLine() = default;

template <typename T>
Option CommandLine::option(const std::string& name, T& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
template Option CommandLine::option(const std::string&, std::string&, const std::string&);
template Option CommandLine::option(const std::string&, double&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<double>&, const std::string&);
template Option CommandLine::option(const std::string&, int&, const std::string&);
template Option CommandLine::option(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<double>&, const std::string&);

Option CommandLine::call(const std::string& name, const std::function<void(const std::string&)>& take,
                         const std::string& help) {
  return Option(app_->add_option_function<std::string>(name, take, help));
}
Option CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}
Option CommandLine::operator[](const std::string& name) { return Option(app_->get_option(name)); }

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  app_->add_flag("--version", "print the version and end");
  // Before parsing: it needs no other argument.
  if (std::find(argv, argv + argc, std::string_view("--version")) != argv + argc) {
    std::cout << "hammer_loads " HAMMER_LOADS_VERSION << '\n';
    return finishOutput();
  }
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& help) {
    return app_->exit(help);
  } catch (const CLI::ParseError& error) {
    std::cerr << app_->get_name() << ": " << onOneLine(error.what()) << " (--help shows the options)\n";
    return kExitWrongUsage;
  }
}

}  // namespace hammer_loads
