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

struct WornRow {
  std::string machine;
  Level level{};
  test::Covered covered;

  double rms(int c) const { return std::sqrt(covered.error[c] / std::max(1, covered.count[c])); }      ///< of Fz [N]
  double stated(int c) const { return std::sqrt(covered.stated[c] / std::max(1, covered.count[c])); }  ///< [N]
};

std::vector<WornRow> wornTable(const Settings& settings, const accuracy::MachineChoice& choice) {
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
  std::vector<WornRow> rows;
  for (const Kind& kind : kKinds) {
    for (const Level level : {Level::kLinkage, Level::kElastic}) {
      if (!choice.has(std::string("worn ") + kind.name + ' ' + nameOf(level))) continue;
      test::WornMachineSettings machine = test::wornMo100(settings);
      machine.duration = 9.0, machine.seed = choice.seed;
      kind.change(machine);
      rows.push_back({kind.name, level, test::coveredOf(settings, machine, level)});
    }
  }
  return rows;
}

/// Errors of Fz over its largest value.
std::string json(const std::vector<WornRow>& rows) {
  std::string text = "[";
  for (const WornRow& row : rows) {
    const test::Covered& covered = row.covered;
    text += format("%s\n  {\"machine\": \"%s\", \"level\": \"%s\", \"energies_within\": %.6g",
                   &row == rows.data() ? "" : ",", row.machine.c_str(), nameOf(row.level),
                   static_cast<double>(covered.energies) / std::max(1, covered.blows));
    for (int c = 0; c < test::Covered::kClasses; ++c)
      text += format(", \"covered_from_%.0f\": %.6g, \"rms_z_from_%.0f\": %.6g", test::Covered::kFrom[c],
                     covered.share(c), test::Covered::kFrom[c], row.rms(c) / covered.largest);
    text += "}";
  }
  return text + "\n]";
}

/// The table of doc/model.md 6: level elastic.
std::string markdown(const std::vector<WornRow>& rows) {
  std::string text = "| machine |", line = "|---|";
  for (int c = 0; c < test::Covered::kClasses; ++c, line += "---|")
    text += format(" %.0f to %.0f deg |", test::Covered::kFrom[c], test::Covered::kFrom[c + 1]);
  text += " Fz, 0 to 30 deg: rms error, stated | blow energies within |\n" + line + "---|---|\n";
  for (const WornRow& row : rows) {
    if (row.level != Level::kElastic) continue;
    text += "| " + row.machine;
    for (int c = 0; c < test::Covered::kClasses; ++c) text += format(" | %.0f %%", 100.0 * row.covered.share(c));
    text +=
        format(" | %.0f N, %.0f N | %d of %d |\n", row.rms(0), row.stated(0), row.covered.energies, row.covered.blows);
  }
  return text;
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
  if (part == "machines" || part == "no_speeds") std::cout << accuracy::json(accuracy::machineTable(*settings, choice));
  if (part == "elastic") std::cout << accuracy::json(accuracy::elasticTable(*settings, choice));
  if (part == "clean") std::cout << accuracy::json(accuracy::sessionTable(*settings));
  if (part == "drawings")
    std::cout << accuracy::json(accuracy::summary(accuracy::drawingTable(*settings, kDrawings, choice.seed)));
  if (part == "worn") {
    const std::vector<WornRow> rows = wornTable(*settings, choice);
    std::cout << (as_table ? markdown(rows) : json(rows));
  }
  if (part == "boom") std::cout << accuracy::json(accuracy::boomTable());
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
