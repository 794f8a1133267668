/// Plays a simulated machine onto topics, in real time or in simulated time.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "hammer_loads/simulation/machine_parameters.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads {

/// Topics: crank (hammer_crank_joint) and joint_states, both sensor_msgs/JointState; of a hull on its boom hull_imu,
/// sensor_msgs/Imu, and cylinder_pressures/NAME/bore and /rod, sensor_msgs/FluidPressure. Stamps are the instants of
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

  void advertiseHull(ros::NodeHandle& node);
  void waitForSubscribers();
  void waitForTime();
  void start();
  void publishClock(double time);
  double elapsed() const;
  void publish(const simulation::Session& session);
  void publishCrank(const simulation::CrankReading& reading);
  void publishJoints(const simulation::JointReading& reading);
  void publishImu(const simulation::HullImuReading& reading);
  void publishPressures(const simulation::PressureReading& reading);

  simulation::SimulatorSettings settings_;
  TimeSource source_;
  ros::Publisher crank_publisher_, joint_publisher_, clock_publisher_, imu_publisher_;
  std::vector<ros::Publisher> pressure_publishers_;  ///< bore and rod of each cylinder in turn
  sensor_msgs::JointState crank_message_, joint_message_;
  sensor_msgs::Imu imu_message_;
  sensor_msgs::FluidPressure pressure_message_;
  std::optional<simulation::SessionStream> stream_;
  SteadyTime steady_start_;
  std::uint64_t crank_count_{}, joint_count_{}, blow_count_{};
};

}  // namespace hammer_loads
