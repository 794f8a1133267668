/// A simulated machine played onto topics, in real time or in simulated time; its truth as files.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/simulation/machine_parameters.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads {

/// PREFIX_samples.csv holds the load on the hull at the instants of the crank readings, PREFIX_blows.csv the blows.
/// Stamps are those of the session [s]; a load is that of links and drive about D in axes of hammer_hull [N], [N m].
class TruthFiles {
 public:
  /// Replaces the files. Throws std::runtime_error when one cannot be written.
  explicit TruthFiles(const std::string& prefix);

  /// Appends a session's truth. start_stamp: of t = 0 [ns].
  void write(const simulation::Session& session, std::int64_t start_stamp);

 private:
  std::ofstream samples_, blows_;
};

/// Topics: crank (hammer_crank_joint) and joint_states, both sensor_msgs/JointState; of a hull on its boom hull_imu,
/// sensor_msgs/Imu, and cylinder_pressures/NAME/bore and /rod, sensor_msgs/FluidPressure. Stamps are the instants of
/// sampling. Published in batches a millisecond long, so a sample is at most about that old when it is sent. Time
/// follows
/// - the steady clock from the wall time of the start on, without /use_sim_time;
/// - /clock, with /use_sim_time; when it jumps back the machine restarts;
/// - its own steps, with /use_sim_time and publish_clock: then it publishes /clock, before the samples up to it.
/// Unless it follows /clock, it adapts to the computer: a batch is at most 5 ms long, and the machine pauses while the
/// diagnostics of the receiving node are 2 s behind. Its time is then slower than the wall clock. It ends when that
/// node has processed the last sample.
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
  void waitForTheLast();
  void start();
  void publishClock(double time);
  double speed() const { return source_ == TimeSource::kOwnClock ? settings_.play.clock_factor : 1.0; }
  double timeAfter(double last);
  bool isFollowed(double last);
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
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
  std::optional<TruthFiles> truth_;
  SteadyTime last_step_;
  double left_out_{};  ///< wall time that the machine did not follow [s]
  ros::Subscriber diagnostics_;
  std::int64_t newest_{};    ///< stamp of the last crank sample [ns]
  std::int64_t followed_{};  ///< newest stamp that a node has taken; 0: none has reported [ns]
  std::uint64_t crank_count_{}, joint_count_{}, blow_count_{};
};

}  // namespace hammer_loads
