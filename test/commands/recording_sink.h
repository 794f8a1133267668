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

#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads::test {

/// Record time and content of each message, by topic without its prefix.
using Recorded = std::map<std::string, std::vector<std::pair<ros::Time, std::vector<std::uint8_t>>>>;

/// Takes everything.
class RecordingSink final : public LoadsSink {
 public:
  void runInfo(const RunInfo& m, const ros::Time& t) override { add("run_info", m, t); }
  void hullWrench(const geometry_msgs::WrenchStamped& m, const ros::Time& t) override { add("hull_wrench", m, t); }
  void boomWrench(const std::string& link, const geometry_msgs::WrenchStamped& m, const ros::Time& t) override {
    add("boom_wrench/" + link, m, t);
  }
  void jointLoads(const JointLoads& m, const ros::Time& t) override { add("joint_loads", m, t); }
  void boomVibration(const BoomVibration& m, const ros::Time& t) override { add("boom_vibration", m, t); }
  void hullLoads(const HullLoads& m, const ros::Time& t) override { add("hull_loads", m, t); }
  void mechanism(const sensor_msgs::JointState& m, const ros::Time& t) override { add("mechanism", m, t); }
  void pinForces(const PinForces& m, const ros::Time& t) override { add("pin_forces", m, t); }
  void blow(const Blow& m, const ros::Time& t) override { add("blow", m, t); }
  void pulse(const Pulse& m, const ros::Time& t) override { add("pulse", m, t); }
  bool wantsBoomWrench(const std::string&) const override { return true; }
  bool wantsJointLoads() const override { return true; }
  bool wantsBoomVibration() const override { return true; }
  bool wantsHullLoads() const override { return true; }
  bool wantsMechanism() const override { return true; }
  bool wantsPinForces() const override { return true; }
  bool wantsTurns() const override { return true; }

  Recorded recorded;

 private:
  template <typename Message>
  void add(const std::string& topic, const Message& message, const ros::Time& time) {
    std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, message);
    recorded[topic].emplace_back(time, std::move(bytes));
  }
};

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

/// The messages of a bag through a LoadsFlow, as the node hands them on.
inline Recorded recordedLive(const std::string& path, const Settings& settings, const std::string& imu_topic) {
  RecordingSink sink;
  LoadsFlow flow(settings, sink);
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
  return sink.recorded;
}

template <typename Message>
std::vector<Message> messagesIn(const std::string& path, const std::string& topic) {
  std::vector<Message> messages;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery(topic)))
    messages.push_back(*item.instantiate<Message>());
  return messages;
}

/// By stamp [ns].
inline std::map<StampNs, geometry_msgs::Wrench> wrenchesIn(const std::string& path, const std::string& topic) {
  std::map<StampNs, geometry_msgs::Wrench> wrenches;
  for (const auto& m : messagesIn<geometry_msgs::WrenchStamped>(path, topic))
    wrenches[static_cast<StampNs>(m.header.stamp.toNSec())] = m.wrench;
  return wrenches;
}

}  // namespace hammer_loads::test
