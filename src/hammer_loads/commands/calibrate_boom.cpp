#include "hammer_loads/commands/calibrate_boom.h"

#include <iostream>

#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/calibration/boom_report.h"
#include "hammer_loads/commands/boom_recording_bag.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/settings/read_boom.h"

namespace hammer_loads {
namespace {

/// A weight's own mass is known to this much, by any scale [-].
constexpr double kKnownWeight = 0.002;

calibration::TipWeight weightOf(const BoomCalibrationJob& job) {
  return {*job.weight, kKnownWeight * *job.weight, job.at[0], job.at[1]};
}

}  // namespace

CalibrationTexts calibrateBoom(const BagInputs& inputs, const Settings& settings, const BoomCalibrationJob& job,
                               const std::string& source) {
  CalibrationTexts result;
  const auto refuse = [&](const std::string& problem) {
    result.problems.push_back(problem);
    return result;
  };
  if (!settings.boom || settings.boom->cylinders().empty())
    return refuse(
        "cylinders: none, must be given for calibrate --boom: a boom file (--params) and a robot description "
        "(--urdf)");
  ProgressBar bar;
  const Progress progress = std::ref(bar);
  std::vector<calibration::WeighedRecording> recordings;
  const auto add = [&](const BagInputs& bags, const calibration::TipWeight& weight) {
    BoomBag bag = readBoomBag(bags, settings, piece(progress, 0.0, 0.1));
    if (!bag.problem.empty()) return result.problems.push_back(bag.problem);
    if (!bag.silent.empty()) std::cerr << "note: " << bag.silent << ": never heard, taken at zero\n";
    recordings.push_back({std::move(bag.recording), weight});
  };
  const bool hangs_in_all = job.weight && job.weighed.empty();
  add(inputs, hangs_in_all ? weightOf(job) : calibration::TipWeight{});
  if (!job.weighed.empty()) {
    const Checked<BagInputs> weighed = BagInputs::open(job.weighed);
    result.problems.insert(result.problems.end(), weighed.problems.begin(), weighed.problems.end());
    if (weighed.value) add(*weighed.value, weightOf(job));
  }
  if (!result.problems.empty()) return result;
  calibration::BoomBasis basis;
  basis.urdf = settings.robot_description;
  basis.parameters = settings.boom->parameters();
  basis.g_B = gravityInRoot(settings.pipeline.gravity, settings.pipeline.base);
  const calibration::BoomCalibration found = calibration::calibrateBoom(basis, recordings, piece(progress, 0.1, 1.0));
  report(progress, 1.0);
  if (!found.problem.empty()) return refuse(inputs.names() + ": " + found.problem);
  result.words = textOf(found);
  result.yaml = yamlOf(found, boomYaml(settings.yaml), source);
  if (!result.yaml.empty()) result.picture = svgOf(found);
  return result;
}

}  // namespace hammer_loads
