/// turn_table: one turn of the hammer at constant crank speed, as CSV or as its pulse.
#include <cmath>
#include <iostream>
#include <limits>

#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/parameters/command_line.h"

namespace hammer_loads {
namespace {

int run(int argc, const char* const* argv) {
  CLI::App app("Load of the hammer on its hull over one turn at constant crank speed", "turn_table");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::string> files;
  std::optional<Level> level;
  double speed = 31.416, step = 1.0, pitch = 0.0;
  bool summary = false;
  addParamsOption(app, files);
  addLevelOption(app, level);
  app.add_option("--speed", speed, "crank speed [rad/s]")->check(numberWithin(0.0, kInfinity, "rad/s"))->capture_default_str();
  app.add_option("--step-deg", step, "between rows [deg]")->check(numberWithin(1e-6, 360.0, "deg"))->capture_default_str();
  const CLI::Option* with_weight = app.add_option("--pitch", pitch, "include the weight, at this hull pitch [rad]")
                                       ->check(numberWithin(-kInfinity, kInfinity, "rad"));
  app.add_flag("--summary", summary, "print the turn's pulse instead of the table");
  if (const auto code = parse(app, argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  const double g = with_weight->count() > 0 ? settings->pipeline.gravity : 0.0;
  const Gravity gravity{g * std::sin(pitch), -g * std::cos(pitch)};
  const TurnTable table{settings->mechanism, level.value_or(settings->pipeline.level), speed, gravity, step};
  if (summary) {
    std::cout << summaryText(pulseAtConstantSpeed(table.mechanism, table.level, speed, gravity));
  } else {
    std::cout << csvHeader() << '\n';
    const std::size_t rows = rowCount(table);
    for (std::size_t i = 0; i < rows && std::cout; ++i) std::cout << csvLine(turnRow(table, i)) << '\n';
  }
  if (std::cout.flush()) return 0;
  std::cerr << "stdout: cannot be written\n";
  return kExitFailure;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
