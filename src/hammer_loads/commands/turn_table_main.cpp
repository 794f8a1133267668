/// turn_table: one turn of the hammer at constant crank speed, as CSV or as its pulse.
#include <cmath>
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/hammer/turn_table.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;

int run(int argc, const char* const* argv) {
  CommandLine line("Load of the hammer on its hull over one turn at constant crank speed", "turn_table");
  std::vector<std::string> files;
  std::optional<Level> level;
  double speed = 31.416, step = 1.0, pitch = 0.0;
  bool summary = false, pins = false;
  addParamsOption(line, files);
  addLevelOption(line, level);
  line.add_option("--speed", speed, "crank speed [rad/s]")
      ->check(within(0.0, kInfinity, "rad/s"))
      ->capture_default_str();
  line.add_option("--step-deg", step, "between rows [deg]")->check(within(1e-6, 360.0, "deg"))->capture_default_str();
  const CLI::Option* with_weight = line.add_option("--pitch", pitch, "include the weight, at this hull pitch [rad]")
                                       ->check(within(-kInfinity, kInfinity, "rad"));
  line.add_flag("--summary", summary, "print the turn's pulse instead of the table");
  line.add_flag("--pins", pins, "add the pin forces and the drive torque to the table");
  if (const auto code = line.parse(argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  const double g = with_weight->count() > 0 ? settings->pipeline.gravity : 0.0;
  const Gravity gravity{g * std::sin(pitch), -g * std::cos(pitch)};
  const HullModel model(settings->mechanism, level.value_or(settings->pipeline.level));
  const TurnTable table{model, speed, gravity, step, pins};
  if (summary) {
    std::cout << summaryText(pulseOfTurn(table));
  } else {
    std::cout << csvHeader(table) << '\n';
    const std::size_t rows = rowCount(table);
    for (std::size_t i = 0; i < rows && std::cout; i += kRowsAtOnce) {
      for (const TurnRow& row : turnRows(table, i, kRowsAtOnce)) std::cout << csvLine(table, row) << '\n';
    }
  }
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
