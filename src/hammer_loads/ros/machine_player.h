/// Plays a simulated machine onto topics, in real time or in simulated time.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/JointState.h>

#include <chrono>
#include <cstdint>
#include <optional>

#include "hammer_loads/simulation/machine_parameters.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads {

/// Topics: crank (hammer_crank_joint) and joint_states, both sensor_msgs/JointState; stamps are the instants of
/// sampling. Published in batches a millisecond long, so a sample is at most about that old when it is sent. Time
/// follows
/// - the steady clock from the wall time of the start on, without /use_sim_time;
/// - /clock, with /use_sim_time; when it jumps back the machine restarts;
/// - its own steps, with /use_sim_time and publish_clock: then it publishes /clock, before the samples up to it.
class MachinePlayer {
 public:
  MachinePlayer(ros::NodeHandle node, const simulation::SimulatorSettings& settings);
  /// Until the machine's duration is over or ROS shuts down.
  void run();

 private:
  enum class TimeSource { kSteadyClock, kClockTopic, kOwnClock };
  using SteadyTime = std::chrono::steady_clock::time_point;

  void waitForSubscribers();
  void waitForTime();
  void start();
  void publishClock(double time);
  double elapsed() const;
  void publish(const simulation::Session& session);
  void publishCrank(const simulation::CrankReading& reading);
  void publishJoints(const simulation::JointReading& reading);

  simulation::SimulatorSettings settings_;
  TimeSource source_;
  ros::Publisher crank_publisher_, joint_publisher_, clock_publisher_;
  sensor_msgs::JointState crank_message_, joint_message_;
  std::optional<simulation::SessionStream> stream_;
  SteadyTime steady_start_;
  std::uint64_t crank_count_{}, joint_count_{}, blow_count_{};
};

}  // namespace hammer_loads
