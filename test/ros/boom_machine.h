/// A machine at work and the live node's answers, for tests of the node with a boom.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/BoomVibration.h>
#include <hammer_loads/JointLoads.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "hammer_loads/simulation/session.h"
#include "ros/eventually.h"

namespace hammer_loads::test {

inline const std::vector<std::string> kJoints(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());

/// Messages of one output by stamp; a stamp that comes twice counts.
template <typename Message>
struct Heard {
  Heard(ros::NodeHandle& node, const std::string& topic)
      : subscriber(node.subscribe<Message>("hammer_loads/" + topic, 20000, [this](const auto& m) {
          repeated += !messages.emplace(m->header.stamp, *m).second;
        })) {}
  /// Of the stamps in [from, to).
  std::size_t count(const ros::Time& from, const ros::Time& to) const {
    return static_cast<std::size_t>(std::distance(messages.lower_bound(from), messages.lower_bound(to)));
  }
  ros::Time last() const { return messages.empty() ? ros::Time() : messages.rbegin()->first; }

  std::map<ros::Time, Message> messages;
  int repeated{};
  ros::Subscriber subscriber;
};

/// A machine that keeps its pose and soon strikes, with what a node says to it.
class Machine {
 public:
  using Wrench = geometry_msgs::WrenchStamped;

  Machine() : stream_(settings()) {
    diagnostics_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 100, [this](const auto& m) {
      for (const auto& status : m->status) statuses_[status.name] = status.message;
    });
  }
  bool isConnected() const {
    for (const ros::Subscriber* output : {&hull.subscriber, &arm.subscriber, &gauge.subscriber, &loads.subscriber,
                                          &vibration.subscriber, &diagnostics_}) {
      if (output->getNumPublishers() == 0) return false;
    }
    return crank_.getNumSubscribers() > 0 && joints_.getNumSubscribers() > 1;  // node, robot_state_publisher
  }

  /// The next joint states, then the crank samples up to their stamp. Waits for a wrench of the last ones, so that no
  /// topic runs ahead of another; samples beside a blow have none.
  bool work() {
    simulation::Session period;
    time_ += kPeriod;
    stream_.advanceTo(time_, period);
    for (const simulation::JointReading& reading : period.joints) tellJoints(reading);
    for (const simulation::CrankReading& reading : period.crank) tellCrank(reading);
    const ros::Time due = samples.back() - ros::Duration(kMostBeside);
    return eventually([this, due] { return hull.last() >= due; });
  }
  bool workUntil(const std::function<bool()>& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(120.0);
    while (!condition()) {
      if (ros::WallTime::now() > deadline || !work()) return false;
    }
    return true;
  }
  /// So much of the machine's time [s].
  bool workFor(double duration) {
    const double end = time_ + duration;
    return workUntil([&] { return time_ >= end; });
  }
  /// A status whose name holds `name` says `text`.
  bool says(const std::string& name, const std::string& text) const {
    for (const auto& [status, message] : statuses_)
      if (status.find(name) != std::string::npos && message.find(text) != std::string::npos) return true;
    return false;
  }

  std::vector<std::string> speaking = kJoints;  ///< joints that tell their angle
  std::vector<ros::Time> samples;               ///< stamps of all crank samples told
  ros::Time last_joints;                        ///< stamp of the last joint states told
  std::array<double, 4> position{};             ///< of the joints [rad]

 private:
  static constexpr double kPeriod = 0.02;      // [s] of joint states
  static constexpr double kMostBeside = 0.03;  // [s] without a wrench, in the first turns

  static simulation::MachineSettings settings() {
    simulation::MachineSettings s = simulation::workingMo100();
    s.duration = 1000.0;
    s.drive.stop_time = 1001.0;
    s.drive.start_time = 0.1;
    s.drive.start_ramp = 0.2;
    for (simulation::JointMotion& joint : s.boom) joint.amplitude = 0.0;
    s.start_stamp = static_cast<std::int64_t>(ros::Time::now().toNSec());
    return s;
  }
  void tellJoints(const simulation::JointReading& reading) {
    position = reading.position;
    if (speaking.empty()) return;
    sensor_msgs::JointState m;
    m.header.stamp = last_joints = ros::Time().fromNSec(static_cast<std::uint64_t>(reading.stamp));
    m.name = speaking;
    for (const std::string& name : speaking) {
      const auto j = static_cast<std::size_t>(std::find(kJoints.begin(), kJoints.end(), name) - kJoints.begin());
      m.position.push_back(reading.position[j]);
    }
    joints_.publish(m);
  }
  void tellCrank(const simulation::CrankReading& reading) {
    sensor_msgs::JointState m;
    m.header.stamp = ros::Time().fromNSec(static_cast<std::uint64_t>(reading.stamp));
    m.name = {"hammer_crank_joint"};
    m.position = {reading.angle};
    m.velocity = {*reading.speed};
    samples.push_back(m.header.stamp);
    crank_.publish(m);
  }

  ros::NodeHandle node_;
  simulation::SessionStream stream_;
  double time_ = 0.005001 - kPeriod;  // just behind the joint states, the first of which are at 5 ms
  ros::Publisher crank_ = node_.advertise<sensor_msgs::JointState>("crank", 10000);
  ros::Publisher joints_ = node_.advertise<sensor_msgs::JointState>("joint_states", 1000);
  ros::Subscriber diagnostics_;
  std::map<std::string, std::string> statuses_;

 public:
  Heard<Wrench> hull{node_, "hull_wrench"}, arm{node_, "boom_wrench/arm_link"};
  Heard<Wrench> gauge{node_, "boom_wrench/strain_gauge"};
  Heard<JointLoads> loads{node_, "joint_loads"};
  Heard<BoomVibration> vibration{node_, "boom_vibration"};
};

}  // namespace hammer_loads::test
