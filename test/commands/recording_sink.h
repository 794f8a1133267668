/// What process_bag wrote and what the live node's flow gives, message by message.
#pragma once

#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/ros/hammer_bridge.h"

namespace hammer_loads::test {

/// Record time and content of each message, by topic without its prefix.
using Recorded = std::map<std::string, std::vector<std::pair<ros::Time, std::vector<std::uint8_t>>>>;

/// Keeps every message of a table of outputs.
template <typename Outputs>
void attachRecorder(Outputs& outputs, Recorded& recorded) {
  outputs.forEach([&](auto& output) {
    output.attach([&messages = recorded[output.name()]](const auto& message, const ros::Time& time) {
      std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
      ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      ros::serialization::serialize(stream, message);
      messages.emplace_back(time, std::move(bytes));
    });
  });
}

inline Recorded recordedIn(const std::string& path) {
  const std::string prefix = "/hammer_loads/";
  Recorded recorded;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    std::vector<std::uint8_t> bytes(item.size());
    ros::serialization::OStream stream(bytes.data(), item.size());
    item.write(stream);
    recorded[item.getTopic().substr(prefix.size())].emplace_back(item.getTime(), std::move(bytes));
  }
  return recorded;
}

/// The messages of a bag through a HammerBridge, as the node hands them on; topics without a message are left out.
inline Recorded recordedLive(const std::string& path, const Settings& settings, const std::string& imu_topic) {
  Recorded recorded;
  HammerBridge flow(settings);
  attachRecorder(flow.outputs(), recorded);
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag)) {
    const std::string topic = item.getTopic();
    const ros::Time time = item.getTime();
    if (topic == "/hammer/crank") flow.crank(*item.instantiate<sensor_msgs::JointState>(), time);
    if (topic == "/joint_states") flow.jointStates(*item.instantiate<sensor_msgs::JointState>(), time);
    if (topic == "/tf" || topic == "/tf_static")
      flow.transforms(*item.instantiate<tf2_msgs::TFMessage>(), topic == "/tf_static", time);
    if (topic == imu_topic) flow.hullImu(*item.instantiate<sensor_msgs::Imu>(), time);
  }
  flow.finishRun();
  for (auto topic = recorded.begin(); topic != recorded.end();)
    topic = topic->second.empty() ? recorded.erase(topic) : std::next(topic);
  return recorded;
}

template <typename Message>
std::vector<Message> messagesIn(const std::string& path, const std::string& topic) {
  std::vector<Message> messages;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery(topic)))
    messages.push_back(*item.instantiate<Message>());
  return messages;
}

}  // namespace hammer_loads::test
