#include <ros/time.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/calibration/boom_recording.h"
#include "hammer_loads/calibration/boom_report.h"
#include "hammer_loads/commands/calibrate.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads {
namespace {

struct BoomBag {
  std::string problem;  ///< one line why it could not be read
  calibration::BoomRecording recording;
  ros::Time begin;     ///< traces count from this stamp
  std::string silent;  ///< joints without a cylinder and without a message, in one line; they are at zero
};

constexpr double kCrankTurns = 0.05;  // [rad]: beyond a few counts of any encoder

class BoomReader {
 public:
  BoomReader(const Settings& settings, calibration::BoomRecording& recording)
      : chain_(settings.boom->chain()), crank_joint_(settings.pipeline.crank_joint), recording_(recording) {
    recording.joint.resize(static_cast<std::size_t>(chain_.joints()));
    recording.pressure.resize(settings.boom->cylinders().size());
  }

  ros::Time begin() const { return first_.value_or(ros::Time()); }  ///< traces count from it
  void joints(const sensor_msgs::JointState& message) {
    for (std::size_t i = 0; i < message.name.size() && i < message.position.size(); ++i) {
      const std::optional<int> joint = chain_.jointIndex(message.name[i]);
      if (joint) add(recording_.joint[static_cast<std::size_t>(*joint)], message.header.stamp, message.position[i]);
    }
  }
  void crank(const sensor_msgs::JointState& message) {
    for (std::size_t i = 0; i < message.name.size() && i < message.position.size(); ++i) {
      if (message.name[i] != crank_joint_ || !std::isfinite(message.position[i])) continue;
      if (crank_ && std::abs(CrankAngle::wrapToPi(message.position[i] - *crank_)) < kCrankTurns) continue;
      const double time = since(message.header.stamp);
      if (crank_ && (recording_.working.empty() || time > recording_.working.back()))
        recording_.working.push_back(time);
      crank_ = message.position[i];
    }
  }
  void pressure(const sensor_msgs::FluidPressure& message, const PressureTopic& topic) {
    add(recording_.pressure[topic.cylinder][static_cast<std::size_t>(topic.chamber)], message.header.stamp,
        message.fluid_pressure);
  }

 private:
  double since(const ros::Time& stamp) {
    if (!first_) first_ = stamp;
    return (stamp - *first_).toSec();
  }
  void add(calibration::Trace& trace, const ros::Time& stamp, double value) {
    const double time = since(stamp);
    if (!std::isfinite(value) || (!trace.time.empty() && !(time > trace.time.back()))) return;
    trace.time.push_back(time), trace.value.push_back(value);
  }

  const Chain& chain_;
  const std::string& crank_joint_;
  calibration::BoomRecording& recording_;
  std::optional<ros::Time> first_;
  std::optional<double> crank_;  ///< crank angle when it last moved [rad]
};

/// Joints of cylinders and pressures that were never heard are a problem; other joints may rest at zero.
std::string whatIsMissing(const Settings& settings, const std::vector<PressureTopic>& topics, BoomBag& bag) {
  const Chain& chain = settings.boom->chain();
  std::set<int> held;
  for (const Cylinder& cylinder : settings.boom->cylinders()) held.insert(cylinder.joint());
  std::vector<std::string> missing, silent;
  for (int j = 0; j < chain.joints(); ++j) {
    if (!bag.recording.joint[static_cast<std::size_t>(j)].time.empty()) continue;
    const std::string& joint = chain.jointNames()[static_cast<std::size_t>(j)];
    if (held.count(j) == 1)
      missing.push_back(joint + " on " + settings.input_topics.joint_states);
    else
      silent.push_back(joint);
  }
  for (const PressureTopic& topic : topics)
    if (bag.recording.pressure[topic.cylinder][static_cast<std::size_t>(topic.chamber)].time.empty())
      missing.push_back(topic.name);
  bag.silent = joined(silent);
  return joined(missing);
}

/// Topics, joints and cylinders as in the settings, which have a boom. Readings that are no numbers, or not newer than
/// the one before, are left out.
BoomBag readBoomBag(const BagInputs& inputs, const Settings& settings) {
  BoomBag result;
  const std::string &joints = settings.input_topics.joint_states, &crank = settings.input_topics.crank;
  const std::vector<PressureTopic> topics = pressureTopics(settings);
  std::map<std::string, const PressureTopic*> pressures;
  std::set<std::string> wanted{joints, crank};
  for (const PressureTopic& topic : topics) pressures[topic.name] = &topic, wanted.insert(topic.name);
  BoomReader reader(settings, result.recording);
  sensor_msgs::JointState state;
  sensor_msgs::FluidPressure pressure;
  result.problem = readOrSay(inputs, [&] {
    BagMessages messages = inputs.messagesOn(wanted);
    while (const BagMessage* item = messages.next()) {
      const std::string& topic = item->connection->topic;
      const auto found = pressures.find(topic);
      if (found != pressures.end()) {
        item->to(pressure);
        reader.pressure(pressure, *found->second);
        continue;
      }
      item->to(state);
      if (topic == joints) reader.joints(state);
      if (topic == crank) reader.crank(state);
    }
  });
  if (!result.problem.empty()) return result;
  result.begin = reader.begin();
  const std::string missing = whatIsMissing(settings, topics, result);
  if (!missing.empty())
    result.problem =
        inputs.names() + ": is without " + missing + ", which is required; topics there: " + inputs.topicList();
  return result;
}

/// A weight's own mass is known to this much, by any scale [-].
constexpr double kKnownWeight = 0.002;

/// Reads bags: one that goes on where the one before ended is its next split, any other a recording of its own.
void addRecordings(const std::vector<std::string>& files, const calibration::TipWeight& weight,
                   const Settings& settings, const Progress& progress, std::vector<calibration::WeighedRecording>& all,
                   std::vector<std::string>& problems) {
  constexpr double kSplitGap = 10.0;  // [s]
  // Numerical: kSplitGap
  ros::Time begin;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Checked<BagInputs> inputs = BagInputs::open({files[i]});
    problems.insert(problems.end(), inputs.problems.begin(), inputs.problems.end());
    if (!inputs.value) continue;
    BoomBag bag = readBoomBag(*inputs.value, settings);
    report(progress, (static_cast<double>(i) + 1.0) / static_cast<double>(files.size()));
    if (!bag.problem.empty()) {
      problems.push_back(bag.problem);
      continue;
    }
    if (!bag.silent.empty() && all.empty()) std::cerr << "note: " << bag.silent << ": never heard, taken at zero\n";
    const double later = begin.isZero() ? -1.0 : (bag.begin - begin).toSec();
    if (later > 0.0 && later < endOf(all.back().recording) + kSplitGap) {
      append(bag.recording, later, all.back().recording);
      continue;
    }
    begin = bag.begin;
    all.push_back({std::move(bag.recording), weight, std::filesystem::path(files[i]).stem().string()});
  }
}

}  // namespace

CalibrationTexts calibrateBoom(const Settings& settings, const CalibrateArguments& given) {
  CalibrationTexts result;
  const auto refuse = [&](const std::string& problem) {
    result.problems.push_back(problem);
    return result;
  };
  if (!settings.boom || settings.boom->cylinders().empty())
    return refuse(
        "cylinders: none, must be given for calibrate --boom: a boom file (--params) and a robot description (--urdf)");
  ProgressBar bar;
  const Progress progress = std::ref(bar);
  calibration::TipWeight weight;
  if (given.weight) weight = {*given.weight, kKnownWeight * *given.weight, given.at[0], given.at[1]};
  std::vector<calibration::WeighedRecording> recordings;
  addRecordings(given.bags, given.weighed.empty() ? weight : calibration::TipWeight{}, settings,
                piece(progress, 0.0, 0.1), recordings, result.problems);
  addRecordings(given.weighed, weight, settings, {}, recordings, result.problems);
  if (!result.problems.empty()) return result;
  calibration::BoomBasis basis;
  basis.urdf = settings.robot_description;
  basis.parameters = settings.boom->parameters();
  basis.g_B = gravityInRoot(settings.pipeline.gravity, settings.pipeline.base);
  const calibration::BoomCalibration found = calibration::calibrateBoom(basis, recordings, piece(progress, 0.1, 1.0));
  report(progress, 1.0);
  if (!found.problem.empty()) return refuse(given.source() + ": " + found.problem);
  result.words = textOf(found);
  result.yaml = yamlOf(found, boomYaml(settings.yaml), given.source());
  if (!result.yaml.empty()) result.picture = svgOf(found);
  return result;
}

}  // namespace hammer_loads
