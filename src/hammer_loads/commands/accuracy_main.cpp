/// accuracy: errors of the loads over simulated working sessions.
#include <fstream>
#include <iostream>

#include "hammer_loads/bench/blow_trace.h"
#include "hammer_loads/bench/boom_table.h"
#include "hammer_loads/bench/drawing_table.h"
#include "hammer_loads/bench/elastic_table.h"
#include "hammer_loads/bench/kdl_observer.h"
#include "hammer_loads/bench/life_table.h"
#include "hammer_loads/bench/machine_table.h"
#include "hammer_loads/bench/scene_table.h"
#include "hammer_loads/bench/session_table.h"
#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"

namespace hammer_loads {
namespace {

constexpr char kSessions[] = "\"sessions\": ", kMachines[] = "\"machines\": ", kBoom[] = "\"boom\": ",
               kElastic[] = "\"elastic\": ", kDrawn[] = "\"drawings\": ", kBlow[] = "\"blow\": ",
               kScene[] = "\"scene\": ";

constexpr int kDrawings = 50;

/// Reason why an existing file must stay; empty: this command wrote it.
std::string whyFileMustStay(const std::string& name) {
  std::string line;
  std::getline(std::ifstream(name), line);
  const auto begins = [&](const char* part) { return line.rfind(std::string("{") + part, 0) == 0; };
  return begins(kSessions) || begins(kElastic) ? "" : "it holds no figures of this command";
}

/// The file for the figures, taken before the computing, which takes a minute.
class JsonFile {
 public:
  JsonFile(const std::string& name, bool force) : name_(name) {
    if (name.empty()) return;
    Checked<OutputFile> file = OutputFile::make({name, {}, force, whyFileMustStay});
    for (const std::string& problem : file.problems) problem_ = problem;
    if (file.value) file_.emplace(*std::move(file.value));
  }
  const std::string& problem() const { return problem_; }
  /// False, with the reason in problem(), where that could not be.
  bool write(const std::string& json) {
    if (!file_) return true;
    std::ofstream stream(file_->path());
    const bool written = (stream << '{' << json << "}\n") && stream.flush();
    problem_ = written ? file_->publish() : name_ + ": cannot be written";
    return problem_.empty();
  }

 private:
  std::string name_, problem_;
  std::optional<OutputFile> file_;
};

/// The settings for machines whose zero is known as well as `calibrate` finds it.
Settings withKnownZero(Settings settings) {
  settings.pipeline.crank_zero_std = 0.003;
  return settings;
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
    std::cout << accuracy::lifeMarkdown(accuracy::boomTable(), accuracy::elasticTable(known));
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
  std::cout << "\n### Damage-equivalent ranges\n\n" << accuracy::lifeMarkdown(boom, elastic);
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
  line.option("--json", json_file, "also write the figures to this file, which must not exist");
  line.flag("--force", force, "replace that file if this command wrote it");
  line.option("--only", only, "drawings, elastic machines, KDL's observer or damage-equivalent ranges (life) alone")
      .oneOf({"drawings", "elastic", "observer", "life"});
  if (const auto code = line.parse(argc, argv)) return *code;
  endCleanlyOnSignals();
  std::optional<Settings> settings = loadOrReport(files);
  if (!settings) return kExitFailure;
  // The hulls of the tables without a boom are held.
  if (settings->pipeline.hull_motion == HullMotionSource::kUnmeasured)
    settings->pipeline.hull_motion = HullMotionSource::kFixed;
  JsonFile file(json_file, force);
  const auto complain = [&] {
    std::cerr << file.problem() << '\n';
    return kExitFailure;
  };
  if (!file.problem().empty()) return complain();
  const std::string json = printTables(*settings, only);
  if (const int code = finishOutput()) return code;
  return file.write(json) ? 0 : complain();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
