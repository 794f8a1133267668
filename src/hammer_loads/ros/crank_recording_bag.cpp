#include "hammer_loads/ros/crank_recording_bag.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/pipeline/hull_pitch.h"

namespace hammer_loads {
namespace {

using calibration::RecordedSample;

class CrankReader {
 public:
  CrankReader(const PipelineSettings& settings, CrankBag& result)
      : settings_(settings), pitch_(settings.pitch_joints, settings.hull_pitch), result_(result) {}

  void joints(const sensor_msgs::JointState& message) {
    pitch_.update(message.name, message.position);
    result_.pitch_known = pitch_.known();
  }
  void crank(const sensor_msgs::JointState& message) {
    const auto found = std::find(message.name.begin(), message.name.end(), settings_.crank_joint);
    const auto i = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end() || i >= message.position.size()) return;
    if (!first_) first_ = message.header.stamp;
    RecordedSample sample;
    sample.time = (message.header.stamp - *first_).toSec();
    sample.reading = message.position[i];
    if (i < message.velocity.size()) sample.speed = message.velocity[i];
    sample.gravity = {settings_.gravity * std::sin(pitch_.pitch()), -settings_.gravity * std::cos(pitch_.pitch())};
    result_.samples.push_back(sample);
  }

 private:
  const PipelineSettings& settings_;
  HullPitch pitch_;
  CrankBag& result_;
  std::optional<ros::Time> first_;
};

}  // namespace

CrankBag readCrankBag(const std::vector<std::string>& files, const std::string& crank_topic,
                      const std::string& joint_topic, const PipelineSettings& settings) {
  CrankBag result;
  CrankReader reader(settings, result);
  for (const std::string& file : files) {
    try {
      rosbag::Bag bag(file, rosbag::bagmode::Read);
      rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{crank_topic, joint_topic}));
      for (const rosbag::MessageInstance& item : view) {
        const auto message = item.instantiate<sensor_msgs::JointState>();
        if (!message) {
          result.problem =
              file + ": " + item.getTopic() + " is of type " + item.getDataType() + ", must be sensor_msgs/JointState";
          return result;
        }
        if (item.getTopic() == joint_topic) reader.joints(*message);
        if (item.getTopic() == crank_topic) reader.crank(*message);
      }
    } catch (const std::exception& error) {
      result.problem = file + ": cannot be read as a bag: " + error.what();
      return result;
    }
  }
  if (result.samples.empty())
    result.problem = files.front() + ": no sample of " + settings.crank_joint + " on " + crank_topic;
  return result;
}

}  // namespace hammer_loads
