/// evaluate: any states of crank and hull as CSV in, motion, hull wrench and pin forces as CSV out.
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/hammer/evaluate.h"

namespace hammer_loads {
namespace {

constexpr char kColumns[] =
    "Columns in, in any order, others ignored: crank_angle_rad, crank_speed_rad_s, crank_accel_rad_s2, "
    "hull_pitch_rad,\n"
    "gravity_m_s2. Crank angle 0 is the blow; -0.000001 or 6.2831843071795864769 lie before it: all digits count.\n"
    "Out: these as given, then the results with 17 digits, for all rows or, if any row is bad, for none.";

int run(int argc, const char* const* argv) {
  CommandLine line("Loads of the hammer for given states: CSV on stdin, CSV on stdout", "evaluate", kColumns);
  std::vector<std::string> files;
  std::optional<Level> level;
  addParamsOption(line, files);
  addLevelOption(line, level);
  if (const auto code = line.parse(argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;

  std::ios::sync_with_stdio(false);
  const HullModel model(settings->mechanism, level.value_or(settings->pipeline.level));
  std::vector<std::string> problems = evaluateTable(model, std::cin, std::cout);
  for (std::string& problem : problems) problem.insert(0, "stdin: ");
  if (!problems.empty()) return fail(problems);
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
