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

constexpr int kDrawings = 50;

/// The settings for machines whose zero is known as well as `calibrate` finds it.
Settings withKnownZero(Settings settings) {
  settings.pipeline.crank_zero_std = 0.003;
  return settings;
}

std::string stated(const accuracy::LifeFigure& f) { return accuracy::percents(1, {f.own, f.common}); }

/// Errors of the damage-equivalent ranges, on which fatigue is judged: hull force z, the worst joint's torque and
/// bending at the worst cut, by the machine and its sensors. For machines with an elastic connecting rod, at levels
/// linkage and elastic, hull force z alone.
accuracy::Table lifeTable(const std::vector<accuracy::BoomLife>& boom,
                          const std::vector<accuracy::ElasticRow>& elastic) {
  accuracy::Table table(4);
  const auto add = [&](const std::vector<std::string>& cells) {
    const char* headers[] = {"machine",      "sensors", "hull force z", "stated: of revolutions, of constants",
                             "joint torque", "stated",  "bending",      "stated"};
    table.beginRow();
    for (std::size_t i = 0; i < std::size(headers); ++i) table.cell(headers[i], i < cells.size() ? cells[i] : "");
  };
  for (const accuracy::BoomLife& r : boom) {
    std::vector<std::string> cells{r.machine, r.sensors};
    for (const accuracy::LifeFigure& f : {r.force, r.torque, r.section}) {
      const bool withheld = std::isnan(f.error);
      cells.push_back(withheld ? "withheld" : format("%+.1f %%", 100.0 * f.error));
      cells.push_back(withheld ? "" : stated(f));
    }
    add(cells);
  }
  for (const accuracy::ElasticRow& r : elastic) {
    const accuracy::LifeFigure &life = r.errors.life, &with_touch = r.errors.life_with_touch;
    if (r.level == Level::kRocker) continue;
    add({r.machine + ", level " + nameOf(r.level), "none",
         format("%+.1f %%; with the touch %+.1f %%", 100.0 * life.error, 100.0 * with_touch.error), stated(life)});
  }
  add({"*others: towers of wind turbines, simulated*", "", "", "", "", "", "5 to 10 %"});
  add({"*others: measured; corrected in the field*", "", "", "", "", "", "10 to 15 %; below 5 %"});
  return table;
}

/// Prints the tables; the same as the members of a JSON object.
std::string printTables(const Settings& settings, const std::string& only) {
  const bool all = only.empty();
  const Settings known = withKnownZero(settings);
  std::vector<std::string> members;
  bool first = true;
  const auto member = [&](const char* key, const std::string& json) {
    members.push_back(format("\"%s\": ", key) + json);
  };
  const auto print = [&](const char* title, const accuracy::Table& table) {
    std::cout << (first ? "" : "\n") << (all ? format("### %s\n\n", title) : "") << table.markdown();
    first = false;
  };
  const auto show = [&](const char* title, const char* key, const accuracy::Table& table) {
    print(title, table), member(key, table.json());
  };
  std::optional<accuracy::Table> sessions;
  if (all) {
    sessions = accuracy::sessionTable(settings);
    member("sessions", sessions->json());
    show("Simulated machines with sensor flaws", "machines", accuracy::machineTable(settings));
  }
  if (all || only == "drawings")
    show("Tolerances of the hammer file", "drawings", accuracy::drawingTable(known, kDrawings));
  std::vector<accuracy::ElasticRow> elastic;
  if (all || only == "elastic" || only == "life") elastic = accuracy::elasticTable(known);
  if (all || only == "elastic") {
    show("Elastic connecting rod", "elastic", accuracy::tableOf(elastic));
    show("Choice of the level", "scene", accuracy::sceneTable(known, elastic));
    member("blow", accuracy::blowTrace(known));
  }
  std::optional<accuracy::BoomTable> boom;
  if (all || only == "life") boom = accuracy::boomTable();
  if (all) show("Boom loads", "boom", boom->errors);
  if (all || only == "observer") print("Comparison with KDL's momentum observer", accuracy::observerTable());
  if (all || only == "life") print("Damage-equivalent ranges", lifeTable(boom->life, elastic));
  if (all) print("Clean sessions", *sessions);
  return joined(members, ",\n");
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
    const auto keep = keepUnlessItBegins({"{\"sessions\": ", "{\"drawings\": ", "{\"elastic\": "},
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
