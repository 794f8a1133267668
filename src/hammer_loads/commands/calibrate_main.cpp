/// calibrate: a recording of the hammer at work in, the crank sensor's place and the drive's inertia out.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "hammer_loads/calibration/report.h"
#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/ros/crank_recording_bag.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

/// With another ending in place of the last one.
std::string pictureBeside(const std::string& file) { return fs::path(file).replace_extension(".svg").string(); }

/// Why an existing file must stay; empty: this command wrote it.
std::string whyFileMustStay(const std::string& name) {
  std::string line;
  std::getline(std::ifstream(name), line);
  const bool ours = line.rfind(calibration::kYamlBegins, 0) == 0 || line.rfind(calibration::kSvgBegins, 0) == 0;
  return ours ? "" : "it holds no calibration";
}

/// Files and what goes into them: first all are filled, then all get their names. False: said why.
bool write(std::vector<OutputFile>& files, const std::vector<std::string>& names,
           const std::vector<std::string>& texts) {
  std::string problem;
  for (std::size_t i = 0; i < files.size() && problem.empty(); ++i) {
    std::ofstream stream(files[i].path(), std::ios::binary);
    if (!((stream << texts[i]) && stream.flush())) problem = names[i] + ": cannot be written";
  }
  for (std::size_t i = 0; i < files.size() && problem.empty(); ++i) problem = files[i].publish();
  if (!problem.empty()) std::cerr << problem << '\n';
  return problem.empty();
}

calibration::Globals inForce(const CrankSensor& sensor) {
  const CrankSensorPlace& p = sensor.place();
  calibration::Globals g = calibration::Globals::Zero();
  g[calibration::kZero] = p.zero * sensor.gain();
  g.segment<2>(calibration::kSine1) << p.eccentricity[0] * std::cos(p.eccentricity_phase[0]),
      p.eccentricity[0] * std::sin(p.eccentricity_phase[0]);
  g.segment<2>(calibration::kSine2) << p.eccentricity[1] * std::cos(p.eccentricity_phase[1]),
      p.eccentricity[1] * std::sin(p.eccentricity_phase[1]);
  return g;
}

int run(int argc, const char* const* argv) {
  CommandLine line("Crank sensor's place and drive's inertia from a recording of the hammer at work", "calibrate");
  std::vector<std::string> bags, params;
  std::string output, crank_topic = "/hammer/crank", joint_topic = "/joint_states";
  bool force = false;
  double rocker_deviation = 0.02;
  line.option("input", bags, "bags to read, splits of one recording in their order").required().type("IN.bag");
  line.option("--write", output, "parameters found, for --params; the picture goes beside it as .svg")
      .required()
      .type("FILE.yaml");
  addParamsOption(line, params);
  line.option("--crank-topic", crank_topic).showDefault();
  line.option("--joint-states-topic", joint_topic, "for the hull's pitch").showDefault();
  line.option("--rocker-inertia-deviation", rocker_deviation, "of the given rocker inertia, relative")
      .within(1e-6, 1.0, "")
      .showDefault();
  line.flag("--force", force, "replaces files that exist");
  if (const auto code = line.parse(argc, argv)) return *code;
  const std::string picture = pictureBeside(output);
  std::vector<std::string> inputs = bags;
  inputs.insert(inputs.end(), params.begin(), params.end());
  if (picture == output) {
    std::cerr << output << ": ends in .svg, must be a name for YAML\n";
    return kExitFailure;
  }
  endCleanlyOnSignals();
  std::vector<OutputFile> files;
  for (const std::string& file : {output, picture}) {
    Checked<OutputFile> made = OutputFile::make({file, inputs, force, whyFileMustStay});
    for (const std::string& problem : made.problems) std::cerr << problem << '\n';
    if (!made.value) return kExitFailure;
    files.push_back(*std::move(made.value));
  }
  const std::optional<Settings> settings = loadOrReport(params);
  if (!settings) return kExitFailure;
  const PipelineSettings& pipeline = settings->pipeline;
  if (pipeline.coupling) {
    std::cerr << "shaft: flexible, must be rigid for calibrate\n";
    return kExitFailure;
  }
  const CrankBag bag = readCrankBag(bags, crank_topic, joint_topic, pipeline);
  if (!bag.problem.empty()) {
    std::cerr << bag.problem << '\n';
    return kExitFailure;
  }
  if (!bag.pitch_known && !pipeline.pitch_joints.empty())
    std::cerr << "note: not every pitch joint is on " << joint_topic
              << ": the hull's pitch is taken as hull_pitch_rad\n";
  const double inertia = settings->mechanism.parameters().rocker_inertia_about_pivot;
  const CrankSensor& sensor = pipeline.crank_sensor;
  const calibration::CalibrationBasis basis{settings->mechanism,
                                            pipeline.level,
                                            sensor.place().ratio,
                                            rocker_deviation,
                                            pipeline.torque_walk * inertia,
                                            pipeline.initial_torque_deviation * inertia,
                                            inForce(sensor)};
  const calibration::Calibration found = calibration::calibrate(bag.samples, basis);
  const std::string yaml = found.problem.empty() ? yamlOf(found, fs::path(bags.front()).filename().string()) : "";
  (yaml.empty() ? std::cerr : std::cout) << (found.problem.empty() ? "" : bags.front() + ": ") << textOf(found);
  if (yaml.empty() || !write(files, {output, picture}, {yaml, svgOf(found)})) return kExitFailure;
  return finishOutput();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
