/// calibrate: a recording of the hammer at work in, the crank sensor's place and the drive's inertia out; with --boom
/// one of the boom's free movement in, a weighed boom out.
#include <console_bridge/console.h>

#include <filesystem>
#include <iostream>

#include "hammer_loads/calibration/boom_report.h"
#include "hammer_loads/calibration/report.h"
#include "hammer_loads/commands/bag_options.h"
#include "hammer_loads/commands/calibrate.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

void addOptions(CommandLine& line, CalibrateArguments& given, BagJob& job) {
  line.add_option("input", given.bags, "bags to read, splits of one recording in their order")
      ->required()
      ->type_name("IN.bag");
  line.add_option("--write", given.output, "parameters found, for --params; the picture goes beside it as .svg")
      ->required()
      ->type_name("FILE.yaml");
  addParamsOption(line, given.params)
      ->description("parameters instead of those of a run_info in the bags; may be repeated");
  addUrdfOption(line, given.urdf)->description("robot description, for the hull's pitch");
  addTopicOption(line, job.topics, &InputTopics::crank);
  addTopicOption(line, job.topics, &InputTopics::joint_states);
  line.add_option("--rocker-inertia-std", given.rocker_std, "of the given rocker inertia, relative")
      ->check(within(1e-6, 1.0, ""))
      ->capture_default_str();
  line.add_flag("--force", given.force, "replaces files that exist");
  line.add_flag("--verbose", given.verbose, "prints every estimate with its limit, strong correlations and notes");
  line.add_flag("--boom", given.boom,
                "weighs the boom instead: from a recording of its free movement without hammering, with cylinder "
                "pressures; writes a boom file")
      ->excludes("--verbose");
  addTopicOption(line, job.topics, &InputTopics::cylinder_pressures)->needs("--boom");
  line.add_option("--weight", given.weight, "a known weight on the tool [kg]")
      ->check(within(0.0, 1e5, "kg"))
      ->type_name("KG")
      ->needs("--boom");
  line.add_option("--at", given.at, "its centre of mass in the tip's frame [m]")
      ->expected(2, 2)
      ->type_name("X Z")
      ->needs("--weight");
  line.get_option("--weight")->needs("--at");
  line.add_option("--weighed", given.weighed, "recording with that weight; IN.bag are then without it")
      ->type_name("BAG")
      ->allow_extra_args(false)
      ->needs("--weight");
}

/// Settings of the last run in the recording, whose sensor is the one that stays in use.
Checked<Settings> settingsOf(const BagInputs& inputs, const BagJob& job, std::vector<BagWarning>& warnings) {
  Checked<Settings> result;
  Checked<std::vector<BagRun>> runs;
  const std::string damage = readOrSay(inputs, [&] { runs = runsOf(inputs, job, warnings); });
  if (!damage.empty()) runs.problems = {damage};
  result.problems = std::move(runs.problems);
  if (!runs.value) return result;
  result.notes = std::move(runs.notes);
  if (runs.value->size() > 1)
    result.notes.push_back(std::to_string(runs.value->size()) + " runs in it: the parameters of the last are used");
  result.value = std::move(runs.value->back().settings);
  return result;
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  if (const auto code = calibrateLinkage(argc, argv)) return *code;
  CommandLine line(
      "Crank sensor's place and drive's inertia from a recording of the hammer at work; or, with --boom, the boom's "
      "masses and friction from one of its free movement",
      "calibrate", "A table of stroke and angle gives the lengths of a bucket linkage: calibrate --linkage --help");
  CalibrateArguments given;
  BagJob job;
  addOptions(line, given, job);
  if (const auto code = line.parse(argc, argv)) return *code;
  const std::string picture = fs::path(given.output).replace_extension(".svg").string();
  std::vector<std::string> inputs = given.bags;
  inputs.insert(inputs.end(), given.params.begin(), given.params.end());
  inputs.insert(inputs.end(), given.weighed.begin(), given.weighed.end());
  if (picture == given.output) return fail({given.output + ": ends in .svg, must be a name for YAML"});
  endCleanlyOnSignals();
  std::vector<OutputFile> files;
  const auto keep = keepUnlessItBegins(
      {calibration::kYamlBegins, calibration::kSvgBegins, calibration::kBoomYamlBegins, calibration::kBoomSvgBegins},
      "it holds no calibration");
  for (const std::string& file : {given.output, picture}) {
    Checked<OutputFile> made = OutputFile::make({file, inputs, given.force, keep});
    if (!made.value) return fail(made.problems);
    files.push_back(*std::move(made.value));
  }
  const std::vector<std::string> bad_files = readParameterFiles(given.params, given.urdf, job);
  if (!bad_files.empty()) return fail(bad_files);
  const Checked<BagInputs> recording = BagInputs::open(given.bags);
  if (!recording.value) return fail(recording.problems);
  std::vector<BagWarning> warnings;
  const Checked<Settings> settings = settingsOf(*recording.value, job, warnings);
  if (!settings.value) return fail(settings.problems);
  for (const std::string& note : settings.notes) std::cerr << "note: " << note << '\n';
  for (const std::string& warning : textsOf(warnings)) std::cerr << "warning: " << warning << '\n';
  return finishCalibration(
      given.boom ? calibrateBoom(*settings.value, given) : calibrateCrank(*recording.value, *settings.value, given),
      files);
}

}  // namespace

std::string CalibrateArguments::source() const { return fs::path(bags.front()).filename().string(); }

std::string readOrSay(const BagInputs& inputs, const std::function<void()>& read) {
  try {
    read();
  } catch (const std::exception& error) {
    return inputs.names() + ": cannot be read: " + onOneLine(error.what());
  }
  return {};
}

int finishCalibration(const CalibrationTexts& texts, std::vector<OutputFile>& files) {
  if (!texts.problems.empty()) return fail(texts.problems);
  (texts.yaml.empty() ? std::cerr : std::cout) << texts.words;
  if (texts.yaml.empty()) return kExitFailure;
  std::string problem;
  for (std::size_t i = 0; i < files.size() && problem.empty(); ++i)
    problem = files[i].fill(i == 0 ? texts.yaml : texts.picture);
  for (std::size_t i = 0; i < files.size() && problem.empty(); ++i) problem = files[i].publish();
  return problem.empty() ? finishOutput() : fail({problem});
}

}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
