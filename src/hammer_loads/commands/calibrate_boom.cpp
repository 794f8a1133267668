#include "hammer_loads/commands/calibrate_boom.h"

#include <filesystem>
#include <functional>
#include <iostream>
#include <utility>

#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/calibration/boom_report.h"
#include "hammer_loads/commands/boom_recording_bag.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/read_boom.h"

namespace hammer_loads {
namespace {

/// A weight's own mass is known to this much, by any scale [-].
constexpr double kKnownWeight = 0.002;

calibration::TipWeight weightOf(const BoomCalibrationJob& job) {
  return {*job.weight, kKnownWeight * *job.weight, job.at[0], job.at[1]};
}

/// Reads bags: one that goes on where the one before ended is its next split, any other a recording of its own.
class Recordings {
 public:
  Recordings(const Settings& settings, std::vector<std::string>& problems) : settings_(settings), problems_(problems) {}

  void add(const std::vector<std::string>& files, const calibration::TipWeight& weight, const Progress& progress) {
    ros::Time begin;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const Checked<BagInputs> inputs = BagInputs::open({files[i]});
      problems_.insert(problems_.end(), inputs.problems.begin(), inputs.problems.end());
      if (!inputs.value) continue;
      BoomBag bag = readBoomBag(*inputs.value, settings_);
      report(progress, (static_cast<double>(i) + 1.0) / static_cast<double>(files.size()));
      if (!bag.problem.empty()) {
        problems_.push_back(bag.problem);
        continue;
      }
      if (!bag.silent.empty() && all_.empty()) std::cerr << "note: " << bag.silent << ": never heard, taken at zero\n";
      const double later = begin.isZero() ? -1.0 : (bag.begin - begin).toSec();
      if (later > 0.0 && later < endOf(all_.back().recording) + kSplitGap) {
        append(bag.recording, later, all_.back().recording);
        continue;
      }
      begin = bag.begin;
      all_.push_back({std::move(bag.recording), weight, std::filesystem::path(files[i]).stem().string()});
    }
  }
  const std::vector<calibration::WeighedRecording>& all() const { return all_; }

 private:
  static constexpr double kSplitGap = 10.0;  // [s]
  // Numerical: kSplitGap
  const Settings& settings_;
  std::vector<std::string>& problems_;
  std::vector<calibration::WeighedRecording> all_;
};

}  // namespace

CalibrationTexts calibrateBoom(const Settings& settings, const BoomCalibrationJob& job, const std::string& source) {
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
  const bool hangs_in_all = job.weight && job.weighed.empty();
  Recordings recordings(settings, result.problems);
  recordings.add(job.bags, hangs_in_all ? weightOf(job) : calibration::TipWeight{}, piece(progress, 0.0, 0.1));
  if (!job.weighed.empty()) recordings.add(job.weighed, weightOf(job), {});
  if (!result.problems.empty()) return result;
  calibration::BoomBasis basis;
  basis.urdf = settings.robot_description;
  basis.parameters = settings.boom->parameters();
  basis.g_B = gravityInRoot(settings.pipeline.gravity, settings.pipeline.base);
  const calibration::BoomCalibration found =
      calibration::calibrateBoom(basis, recordings.all(), piece(progress, 0.1, 1.0));
  report(progress, 1.0);
  if (!found.problem.empty()) return refuse(source + ": " + found.problem);
  result.words = textOf(found);
  result.yaml = yamlOf(found, boomYaml(settings.yaml), source);
  if (!result.yaml.empty()) result.picture = svgOf(found);
  return result;
}

}  // namespace hammer_loads
