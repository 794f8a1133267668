/// ablation: the figures of doc/accuracy.md that estimators decide, as JSON. scripts/ablate runs it with and without a
/// mechanism. Only builds with HAMMER_LOADS_ABLATION have it.
#include <iostream>

#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/drawing_table.h"
#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/commands/command_line.h"

namespace hammer_loads {
namespace {

constexpr int kDrawings = 20;

int run(int argc, const char* const* argv) {
  CommandLine line("Figures of one part of doc/accuracy.md as JSON, for scripts/ablate", "ablation");
  std::vector<std::string> files;
  std::string part = "machines";
  accuracy::MachineChoice choice;
  auto seed = static_cast<std::int64_t>(choice.seed);
  addParamsOption(line, files);
  line.add_option("--part", part, "table")->check(CLI::IsMember({"machines", "elastic", "clean", "drawings", "boom"}));
  line.add_option("--rows", choice.rows, "regular expression that the machine's name and rate must contain");
  line.add_option("--seed", seed, "of the machines' random numbers");
  if (const auto code = line.parse(argc, argv)) return *code;
  choice.seed = static_cast<std::uint64_t>(seed);
  std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;
  if (settings->pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings->pipeline.hull_motion = HullMotionSource::kFixed;
  if (part == "machines") std::cout << accuracy::json(accuracy::machineTable(*settings, choice));
  if (part == "elastic") std::cout << accuracy::json(accuracy::elasticTable(*settings, choice));
  if (part == "clean") std::cout << accuracy::json(accuracy::sessionTable(*settings));
  if (part == "drawings")
    std::cout << accuracy::json(accuracy::summary(accuracy::drawingTable(*settings, kDrawings, choice.seed)));
  if (part == "boom") std::cout << accuracy::json(accuracy::boomTable());
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
