#include "hammer_loads/commands/command_line.h"

#include <cmath>
#include <iostream>

#include "hammer_loads/settings/version.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {

CommandLine::CommandLine(const std::string& description, const std::string& name, const std::string& text)
    : CLI::App(description, name) {
  footer(text);
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  set_version_flag("--version", std::string("hammer_loads ") + packageVersion(), "print the version and end");
  try {
    CLI::App::parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& answer) {  // to --help or --version
    exit(answer);
    return finishOutput();
  } catch (const CLI::ParseError& error) {
    std::cerr << get_name() << ": " << onOneLine(error.what()) << " (--help shows the options)\n";
    return kExitWrongUsage;
  }
}

CLI::Validator within(double least, double most, const std::string& unit) {
  std::string words = "a finite number";
  if (std::isfinite(least)) words += (least == 0.0 ? " > " : " >= ") + numberText(least);
  if (std::isfinite(most)) words += (std::isfinite(least) ? " and <= " : " <= ") + numberText(most);
  const auto rule = [=](std::string& text) {
    const std::optional<double> value = asNumber(YAML::Node(text));
    const bool positive = least != 0.0 || (value && *value > 0.0);
    const bool good = value && std::isfinite(*value) && *value >= least && *value <= most && positive;
    return good ? std::string{} : text + (unit.empty() ? "" : " " + unit) + ", must be " + words;
  };
  return CLI::Validator(rule, "");
}

int fail(const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  return kExitFailure;
}

CLI::Option* addParamsOption(CommandLine& line, std::vector<std::string>& files) {
  return line.add_option("--params", files, "parameters over the shipped ones; may be repeated, the last one wins")
      ->allow_extra_args(false)
      ->type_name("FILE.yaml");
}

void addLevelOption(CommandLine& line, std::optional<Level>& level) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : kRigidLevelNames) words.emplace_back(word);
  const auto take = [&level](const std::string& given) {
    for (const auto& [word, meaning] : kRigidLevelNames) {
      if (given == word) level = meaning;
    }
  };
  line.add_option_function<std::string>("--level", take,
                                        "how much of the mechanism has mass; without it as in the parameters")
      ->check(CLI::IsMember(words))
      ->type_name("LEVEL");
}

CLI::Option* addUrdfOption(CommandLine& line, std::string& file) {
  return line.add_option("--urdf", file, "robot description; with it the boom's loads as well")->type_name("FILE.urdf");
}

int finishOutput() {
  if (std::cout.flush()) return 0;
  std::cerr << "stdout: cannot be written\n";
  return kExitFailure;
}

std::optional<Settings> loadOrReport(const std::vector<std::string>& files) {
  Checked<Settings> settings = loadFiles(configDirectory(), files);
  if (fail(settings.problems); !settings.value) return std::nullopt;
  for (const std::string& note : settings.notes) std::cerr << "note: " << note << '\n';
  return std::move(settings.value);
}

}  // namespace hammer_loads
