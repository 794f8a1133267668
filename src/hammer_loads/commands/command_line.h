/// Functions common to the commands: options, one line per error on stderr, exit codes.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/file_text.h"

namespace hammer_loads {

constexpr int kExitFailure = 1;     ///< bad parameters or input
constexpr int kExitWrongUsage = 2;  ///< bad command line

class CommandLine : public CLI::App {
 public:
  CommandLine(const std::string& description, const std::string& name, const std::string& footer = {});
  /// Empty if the command may continue, otherwise the exit code (0 after --help and --version). An error is one line.
  std::optional<int> parse(int argc, const char* const* argv);
};

/// Rule for a finite number; `least` is excluded when it is 0.
CLI::Validator within(double least, double most, const std::string& unit);

/// Prints the problems on stderr, one line each. Returns kExitFailure.
int fail(const std::vector<std::string>& problems);

/// Adds `--params FILE.yaml`, which may be repeated.
CLI::Option* addParamsOption(CommandLine& line, std::vector<std::string>& files);

/// Adds `--level`, limited to the levels of the model; without it `level` stays as it is.
void addLevelOption(CommandLine& line, std::optional<Level>& level);

/// Exit code of a command that has written its result to stdout; reports when that cannot be written.
int finishOutput();

/// Adds `--urdf FILE`, the robot description that the boom is made from.
CLI::Option* addUrdfOption(CommandLine& line, std::string& file);

/// Settings from files over the shipped ones; every problem and note on stderr, one line each.
std::optional<Settings> loadOrReport(const std::vector<std::string>& files);

}  // namespace hammer_loads
