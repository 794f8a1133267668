#include "hammer_loads/commands/boom_recording_bag.h"

#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

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
  std::string missing;
  const auto name = [](std::string& list, const std::string& one) { list += (list.empty() ? "" : ", ") + one; };
  for (int j = 0; j < chain.joints(); ++j) {
    if (!bag.recording.joint[static_cast<std::size_t>(j)].time.empty()) continue;
    const std::string& joint = chain.jointNames()[static_cast<std::size_t>(j)];
    if (held.count(j) == 1)
      name(missing, joint + " on " + settings.input_topics.joint_states);
    else
      name(bag.silent, joint);
  }
  for (const PressureTopic& topic : topics)
    if (bag.recording.pressure[topic.cylinder][static_cast<std::size_t>(topic.chamber)].time.empty())
      name(missing, topic.name);
  return missing;
}

}  // namespace

BoomBag readBoomBag(const BagInputs& inputs, const Settings& settings, const Progress& progress) {
  BoomBag result;
  const std::string &joints = settings.input_topics.joint_states, &crank = settings.input_topics.crank;
  const std::vector<PressureTopic> topics = pressureTopics(settings);
  std::map<std::string, const PressureTopic*> pressures;
  std::set<std::string> wanted{joints, crank};
  for (const PressureTopic& topic : topics) pressures[topic.name] = &topic, wanted.insert(topic.name);
  BoomReader reader(settings, result.recording);
  sensor_msgs::JointState state;
  sensor_msgs::FluidPressure pressure;
  try {
    BagMessages messages = inputs.messagesOn(wanted);
    const auto count = static_cast<double>(messages.size());
    double done = 0.0;
    while (const BagMessage* item = messages.next()) {
      report(progress, ++done / count);
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
    result.begin = reader.begin();
  } catch (const std::exception& error) {
    result.problem = inputs.names() + ": cannot be read: " + onOneLine(error.what());
    return result;
  }
  const std::string missing = whatIsMissing(settings, topics, result);
  if (!missing.empty())
    result.problem =
        inputs.names() + ": is without " + missing + ", which is required; topics there: " + inputs.topicList();
  return result;
}

}  // namespace hammer_loads
