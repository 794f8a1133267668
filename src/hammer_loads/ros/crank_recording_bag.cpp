#include "hammer_loads/ros/crank_recording_bag.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "hammer_loads/pipeline/hull_pitch.h"
#include "hammer_loads/ros/bag_messages.h"

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
  sensor_msgs::JointState message;
  for (const std::string& file : files) {
    try {
      std::vector<std::unique_ptr<BagFile>> bag;
      bag.push_back(std::make_unique<BagFile>(file));
      BagMessages messages(bag, [&](const BagConnection& connection) {
        return connection.topic == crank_topic || connection.topic == joint_topic;
      });
      while (const BagMessage* item = messages.next()) {
        const std::string& topic = item->connection->topic;
        if (!item->is<sensor_msgs::JointState>()) {
          result.problem =
              file + ": " + topic + " is of type " + item->connection->type + ", must be sensor_msgs/JointState";
          return result;
        }
        item->to(message);
        if (topic == joint_topic) reader.joints(message);
        if (topic == crank_topic) reader.crank(message);
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
