/// accuracy: errors of the loads over simulated working sessions.
#include <iostream>

#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/drawing_table.h"
#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/kdl_observer.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/scene_table.h"
#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr char kSessions[] = "\"sessions\": ", kMachines[] = "\"machines\": ", kBoom[] = "\"boom\": ",
               kElastic[] = "\"elastic\": ", kDrawn[] = "\"drawings\": ", kBlow[] = "\"blow\": ",
               kScene[] = "\"scene\": ";

constexpr int kDrawings = 50;

/// The settings for machines whose zero is known as well as `calibrate` finds it.
Settings withKnownZero(Settings settings) {
  settings.pipeline.crank_zero_std = 0.003;
  return settings;
}

std::string stated(const accuracy::LifeFigure& f) { return format("%.1f, %.1f %%", 100.0 * f.own, 100.0 * f.common); }
std::string cells(const accuracy::LifeFigure& f) {
  if (std::isnan(f.error)) return " withheld | |";
  return format(" %+.1f %% | ", 100.0 * f.error) + stated(f) + " |";
}

/// Errors of the damage-equivalent ranges, on which fatigue is judged, as a table in Markdown: hull force z, the worst
/// joint's torque and bending at the worst cut, by the machine and its sensors. For machines with an elastic connecting
/// rod, at levels linkage and elastic, hull force z alone.
std::string lifeMarkdown(const std::vector<accuracy::BoomRow>& boom, const std::vector<accuracy::ElasticRow>& elastic) {
  std::string text =
      "| machine | sensors | hull force z | stated: of revolutions, of constants | joint torque | stated | bending | "
      "stated |\n|---|---|---|---|---|---|---|---|\n";
  for (const accuracy::BoomRow& r : boom)
    text += "| " + r.machine + " | " + r.sensors + " |" + cells(r.life_force) + cells(r.life_torque) +
            cells(r.life_section) + "\n";
  for (const accuracy::ElasticRow& r : elastic) {
    const accuracy::LifeFigure &life = r.errors.life, &with_touch = r.errors.life_with_touch;
    if (r.level != Level::kRocker)
      text += format("| %s, level %s | none | %+.1f %%; with the touch %+.1f %% | %s | | | | |\n", r.machine.c_str(),
                     nameOf(r.level), 100.0 * life.error, 100.0 * with_touch.error, stated(life).c_str());
  }
  return text +
         "| *others: towers of wind turbines, simulated* | | | | | | 5 to 10 % | |\n"
         "| *others: measured; corrected in the field* | | | | | | 10 to 15 %; below 5 % | |\n";
}

/// Prints the tables; the same as the members of a JSON object.
std::string printTables(const Settings& settings, const std::string& only) {
  const Settings known = withKnownZero(settings);
  if (only == "drawings") {
    const auto drawings = accuracy::summary(accuracy::drawingTable(known, kDrawings));
    std::cout << accuracy::markdown(drawings);
    return kDrawn + accuracy::json(drawings);
  }
  if (only == "observer") {
    std::cout << accuracy::markdown(accuracy::observerTable());
    return "";
  }
  if (only == "life") {
    std::cout << lifeMarkdown(accuracy::boomTable(), accuracy::elasticTable(known));
    return "";
  }
  if (only == "elastic") {
    const std::vector<accuracy::ElasticRow> elastic = accuracy::elasticTable(known);
    std::cout << accuracy::markdown(elastic);
    const std::vector<accuracy::SceneRow> scene = accuracy::sceneTable(known, elastic);
    std::cout << "\n" << accuracy::markdown(scene);
    return kElastic + accuracy::json(elastic) + ",\n" + kScene + accuracy::json(scene) + ",\n" + kBlow +
           accuracy::json(accuracy::blowTrace(known));
  }
  const std::vector<accuracy::SessionRow> sessions = accuracy::sessionTable(settings);
  const std::vector<accuracy::MachineRow> machines = accuracy::machineTable(settings);
  std::cout << "### Simulated machines with sensor flaws\n\n" << accuracy::markdown(machines);
  const auto drawings = accuracy::summary(accuracy::drawingTable(known, kDrawings));
  std::cout << "\n### Tolerances of the hammer file\n\n" << accuracy::markdown(drawings);
  const std::vector<accuracy::ElasticRow> elastic = accuracy::elasticTable(known);
  std::cout << "\n### Elastic connecting rod\n\n" << accuracy::markdown(elastic);
  const std::vector<accuracy::SceneRow> scene = accuracy::sceneTable(known, elastic);
  std::cout << "\n### Choice of the level\n\n" << accuracy::markdown(scene);
  const std::vector<accuracy::BoomRow> boom = accuracy::boomTable();
  std::cout << "\n### Boom loads\n\n" << accuracy::markdown(boom);
  std::cout << "\n### Comparison with KDL's momentum observer\n\n" << accuracy::markdown(accuracy::observerTable());
  std::cout << "\n### Damage-equivalent ranges\n\n" << lifeMarkdown(boom, elastic);
  std::cout << "\n### Clean sessions\n\n" << accuracy::markdown(sessions);
  return kSessions + accuracy::json(sessions) + ",\n" + kMachines + accuracy::json(machines) + ",\n" + kDrawn +
         accuracy::json(drawings) + ",\n" + kBoom + accuracy::json(boom) + ",\n" + kElastic + accuracy::json(elastic) +
         ",\n" + kScene + accuracy::json(scene) + ",\n" + kBlow + accuracy::json(accuracy::blowTrace(known));
}

int run(int argc, const char* const* argv) {
  CommandLine line("Errors of the loads over simulated working sessions", "accuracy");
  std::vector<std::string> files;
  std::string json_file, only;
  bool force = false;
  addParamsOption(line, files);
  line.add_option("--json", json_file, "also write the figures to this file, which must not exist");
  line.add_flag("--force", force, "replace that file if this command wrote it");
  line.add_option("--only", only, "drawings, elastic machines, KDL's observer or damage-equivalent ranges (life) alone")
      ->check(CLI::IsMember({"drawings", "elastic", "observer", "life"}));
  if (const auto code = line.parse(argc, argv)) return *code;
  endCleanlyOnSignals();
  std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;
  // The hulls of the tables without a boom are held.
  if (settings->pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings->pipeline.hull_motion = HullMotionSource::kFixed;
  std::optional<OutputFile> file;  // taken before the computing, which takes a minute
  if (!json_file.empty()) {
    const auto keep = keepUnlessItBegins({std::string("{") + kSessions, std::string("{") + kElastic},
                                         "it holds no figures of this command");
    Checked<OutputFile> made = OutputFile::make({json_file, {}, force, keep});
    if (!made.value) return fail(made.problems);
    file.emplace(*std::move(made.value));
  }
  const std::string json = printTables(*settings, only);
  if (const int code = finishOutput()) return code;
  if (!file) return 0;
  std::string problem = file->fill('{' + json + "}\n");
  if (problem.empty()) problem = file->publish();
  return problem.empty() ? 0 : fail({problem});
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
