/// process_bag: a recording in, the hammer's loads or the grapple's motion out.
#include <console_bridge/console.h>

#include <fstream>
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/ros/bag_output.h"
#include "hammer_loads/ros/bag_processing.h"

namespace hammer_loads {
namespace {

struct Arguments {
  std::vector<std::string> bags;  ///< inputs, then the output
  std::vector<std::string> params, grapple;
  std::string urdf;
  bool force{};
};

void addOptions(CLI::App& app, Arguments& given, BagJob& job) {
  app.add_option("bags", given.bags,
                 "IN.bag... OUT.bag: the bags of one recording, then the bag to write, which must not exist")
      ->required()
      ->expected(2, 1000000);
  app.add_flag("--force", given.force, "replace OUT.bag if it holds outputs of this package and nothing else");
  addParamsOption(app, given.params);
  app.get_option("--params")->description("parameters instead of those of a run_info in the bags; may be repeated");
  addUrdfOption(app, given.urdf);
  const auto topic = [&](const char* option, std::string& name, const std::string& by_default) {
    app.add_option(option, name)->type_name("TOPIC")->default_str("as in run_info, else " + by_default);
  };
  topic("--crank-topic", job.topics.crank, kDefaultTopics.crank);
  topic("--joint-states-topic", job.topics.joint_states, kDefaultTopics.joint_states);
  topic("--imu-topic", job.topics.hull_imu, kDefaultTopics.hull_imu);
  topic("--pressures-topic", job.topics.cylinder_pressures, kDefaultTopics.cylinder_pressures);
  app.get_option("--pressures-topic")
      ->description("prefix; the topics below it are NAME/bore and NAME/rod per cylinder");
  app.add_option("--output-prefix", job.output_prefix, "of every topic written")->capture_default_str();
  app.add_flag("--pins", job.pins, "pin forces as well");
  app.add_option("--grapple", given.grapple, "the grapple as well, from --joint-states-topic; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE.yaml");
  app.add_option("--grapple-prefix", job.grapple_prefix, "of the grapple's topics")->capture_default_str();
}

int fail(const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  return kExitFailure;
}

/// Parameters, robot description and grapple of the job; what is wrong with their files, one line each.
std::vector<std::string> readFiles(const Arguments& given, BagJob& job) {
  std::vector<std::string> problems;
  ParameterMap parameters;
  if (!given.params.empty() && addFiles(given.params, parameters, problems)) job.parameters = std::move(parameters);
  if (!given.urdf.empty()) {
    Checked<std::string> description = fileText(given.urdf);
    problems.insert(problems.end(), description.problems.begin(), description.problems.end());
    job.robot_description = std::move(description.value);
  }
  if (!given.grapple.empty()) {
    Checked<GrappleSettings> grapple = loadGrappleSettings(configDirectory(), given.grapple);
    problems.insert(problems.end(), grapple.problems.begin(), grapple.problems.end());
    job.grapple = std::move(grapple.value);
  }
  return problems;
}

Checked<OutputFile> takeOutput(const Arguments& given, const BagJob& job) {
  const auto named = [](const std::string& given_name, const std::string& by_default) {
    return given_name.empty() ? by_default : given_name;
  };
  const std::vector<std::string> topics{named(job.topics.crank, kDefaultTopics.crank),
                                        named(job.topics.joint_states, kDefaultTopics.joint_states),
                                        named(job.topics.hull_imu, kDefaultTopics.hull_imu)};
  return OutputFile::make({given.bags.back(), job.inputs, given.force,
                           [&topics](const std::string& name) { return whyBagMustStay(name, topics); }});
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);  // rosbag formats a line for every message
  CLI::App app("Loads of the hammer, motion of the grapple from a recorded bag", "process_bag");
  Arguments given;
  BagJob job;
  addOptions(app, given, job);
  if (const auto code = parse(app, argc, argv)) return *code;
  endCleanlyOnSignals();
  job.inputs.assign(given.bags.begin(), given.bags.end() - 1);
  const std::vector<std::string> bad_files = readFiles(given, job);
  if (!bad_files.empty()) return fail(bad_files);
  Checked<OutputFile> output = takeOutput(given, job);
  if (!output.value) return fail(output.problems);
  job.output = output.value->path();

  ProgressBar bar;
  BagReport report;
  std::vector<std::string> problems = processBag(job, std::ref(bar), report);
  for (std::string& problem : problems) {
    if (problem.rfind(job.output + ":", 0) == 0) problem.replace(0, job.output.size(), given.bags.back());
  }
  if (!problems.empty()) return fail(problems);
  const std::string problem = output.value->publish();
  if (!problem.empty()) return fail({problem});
  for (const std::string& note : report.notes) std::cerr << "note: " << note << '\n';
  std::cerr << textOf(report);
  for (const std::string& warning : report.warnings) std::cerr << "warning: " << warning << '\n';
  std::cout << given.bags.back() << ": " << summaryOf(report) << std::endl;
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
