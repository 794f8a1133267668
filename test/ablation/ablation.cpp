/// ablation: the figures of doc/accuracy.md that estimators decide, and those of worn machines, as JSON. scripts/ablate
/// runs it with and without a mechanism. Only builds with HAMMER_LOADS_ABLATION have it.
#include <iostream>

#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/drawing_table.h"
#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/util/format.h"
#include "support/worn_run.h"

namespace hammer_loads {
namespace {

constexpr int kDrawings = 20;

/// Worn machines as JSON, errors of Fz over its largest value; or as the table of doc/model.md 6, of level elastic.
std::string wornRows(const Settings& settings, const accuracy::MachineChoice& choice, bool as_table) {
  struct Kind {
    const char* name;
    void (*change)(test::WornMachineSettings&);
  };
  constexpr Kind kKinds[] = {
      {"none of it", [](auto&) {}},
      {"friction 0.02", [](auto& m) { m.friction = 0.02; }},
      {"friction 0.04", [](auto& m) { m.friction = 0.04; }},
      {"friction 0.08", [](auto& m) { m.friction = 0.08; }},
      {"clearance 0.05 mm in each pin", [](auto& m) { m.clearance = 5e-5; }},
      {"clearance 0.1 mm in each pin", [](auto& m) { m.clearance = 1e-4; }},
      {"clearance 0.2 mm in each pin", [](auto& m) { m.clearance = 2e-4; }},
      {"damping ratio 0.1", [](auto& m) { m.damping_ratio = 0.1; }},
      {"damping ratio 0.05", [](auto& m) { m.damping_ratio = 0.05; }},
      {"restitution 0.06", [](auto& m) { m.restitution = 0.06, m.restitution_spread = 0.0; }},
      {"bow 4 mm, bending mode 500 Hz", [](auto& m) { m.bow = 4e-3, m.bending_frequency = 500.0; }},
      {"bow 4 mm, bending mode 300 Hz", [](auto& m) { m.bow = 4e-3, m.bending_frequency = 300.0; }},
      {"tool to 10 mm late in a fifth of the revolutions", [](auto& m) { m.late = 0.01, m.late_share = 0.2; }},
      {"friction 0.05, clearance 0.1 mm, bow 3 mm with 450 Hz, damping ratio 0.12, late tool", [](auto& m) {
         m.friction = 0.05, m.clearance = 1e-4, m.bow = 3e-3, m.bending_frequency = 450.0, m.damping_ratio = 0.12;
         m.late = 8e-3, m.late_share = 0.1, m.restitution = 0.25, m.restitution_spread = 0.1;
       }}};
  constexpr auto& kFrom = test::Covered::kFrom;
  std::string json, table = "| machine |", line = "|---|";
  for (int c = 0; c < test::Covered::kClasses; ++c, line += "---|")
    table += format(" %.0f to %.0f deg |", kFrom[c], kFrom[c + 1]);
  table += " Fz, 0 to 30 deg: rms error, stated | blow energies within |\n" + line + "---|---|\n";
  for (const Kind& kind : kKinds) {
    for (const Level level : {Level::kLinkage, Level::kElastic}) {
      if (!choice.has(std::string("worn ") + kind.name + ' ' + nameOf(level))) continue;
      test::WornMachineSettings machine = test::wornMo100(settings);
      machine.duration = 9.0, machine.seed = choice.seed;
      kind.change(machine);
      const test::Covered covered = test::coveredOf(settings, machine, level);
      const auto rms = [&](double sum, int c) { return std::sqrt(sum / std::max(1, covered.count[c])); };
      const double energies = static_cast<double>(covered.energies) / std::max(1, covered.blows);
      json += format("%s\n  {\"machine\": \"%s\", \"level\": \"%s\", \"energies_within\": %.6g",
                     json.empty() ? "" : ",", kind.name, nameOf(level), energies);
      for (int c = 0; c < test::Covered::kClasses; ++c)
        json += format(", \"covered_from_%.0f\": %.6g, \"rms_z_from_%.0f\": %.6g", kFrom[c], covered.share(c), kFrom[c],
                       rms(covered.error[c], c) / covered.largest);
      json += "}";
      if (level != Level::kElastic) continue;
      table += std::string("| ") + kind.name;
      for (int c = 0; c < test::Covered::kClasses; ++c) table += format(" | %.0f %%", 100.0 * covered.share(c));
      table += format(" | %.0f N, %.0f N | %d of %d |\n", rms(covered.error[0], 0), rms(covered.stated[0], 0),
                      covered.energies, covered.blows);
    }
  }
  return as_table ? table : "[" + json + "\n]";
}

int run(int argc, const char* const* argv) {
  CommandLine line("Figures of one part of doc/accuracy.md as JSON, for scripts/ablate", "ablation");
  std::vector<std::string> files;
  std::string part = "machines";
  bool as_table = false;
  accuracy::MachineChoice choice;
  auto seed = static_cast<std::int64_t>(choice.seed);
  addParamsOption(line, files);
  line.add_option("--part", part, "table")
      ->check(CLI::IsMember({"machines", "no_speeds", "elastic", "clean", "drawings", "worn", "boom"}));
  line.add_option("--rows", choice.rows, "regular expression that the machine's name and rate must contain");
  line.add_flag("--table", as_table, "worn machines as the table of doc/model.md");
  line.add_option("--seed", seed, "of the machines' random numbers");
  if (const auto code = line.parse(argc, argv)) return *code;
  choice.seed = static_cast<std::uint64_t>(seed);
  std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;
  if (settings->pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings->pipeline.hull_motion = HullMotionSource::kFixed;
  choice.speeds = part != "no_speeds";
  if (part == "machines" || part == "no_speeds") std::cout << accuracy::machineTable(*settings, choice).json();
  if (part == "elastic") std::cout << accuracy::tableOf(accuracy::elasticTable(*settings, choice)).json();
  if (part == "clean") std::cout << accuracy::sessionTable(*settings).json();
  if (part == "drawings") std::cout << accuracy::drawingTable(*settings, kDrawings, choice.seed).json();
  if (part == "worn") std::cout << wornRows(*settings, choice, as_table);
  if (part == "boom") std::cout << accuracy::boomTable().errors.json();
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
