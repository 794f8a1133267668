/// process_bag: a recorded bag in, the hammer's loads or the grapple's motion out.
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/ros/bag_processing.h"

namespace hammer_loads {
namespace {

Checked<GrappleSettings> grappleOrReport(const std::vector<std::string>& files) {
  Checked<GrappleSettings> grapple = loadGrappleSettings(configDirectory(), files);
  for (const std::string& problem : grapple.problems) std::cerr << problem << '\n';
  return grapple;
}

int run(int argc, const char* const* argv) {
  CLI::App app("Loads of the hammer, motion of the grapple from a recorded bag", "process_bag");
  BagJob job;
  std::vector<std::string> files, grapple_files;
  app.add_option("input", job.input, "bag to read")->required();
  app.add_option("output", job.output, "bag to write")->required();
  addParamsOption(app, files);
  std::string urdf;
  addUrdfOption(app, urdf);
  app.add_option("--crank-topic", job.crank_topic)->capture_default_str();
  app.add_option("--joint-states-topic", job.joint_topic)->capture_default_str();
  app.add_option("--imu-topic", job.imu_topic, "with hull_motion imu")->capture_default_str();
  app.add_option("--output-prefix", job.output_prefix, "of every topic written")->capture_default_str();
  app.add_flag("--pins", job.pins, "pin forces as well");
  app.add_option("--grapple", grapple_files, "the grapple as well, from --joint-states-topic; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE.yaml");
  app.add_option("--grapple-prefix", job.grapple_prefix, "of the grapple's topics")->capture_default_str();
  if (const auto code = parse(app, argc, argv)) return *code;
  const std::optional<Settings> settings = loadOrReport(files, urdf);
  if (!grapple_files.empty()) job.grapple = grappleOrReport(grapple_files).value;
  if (!settings || job.grapple.has_value() == grapple_files.empty()) return kExitFailure;

  ProgressBar bar;
  BagReport report;
  const std::string problem = processBag(job, *settings, std::ref(bar), report);
  if (!problem.empty()) {
    std::cerr << problem << '\n';
    return kExitFailure;
  }
  std::cerr << textOf(report);
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
