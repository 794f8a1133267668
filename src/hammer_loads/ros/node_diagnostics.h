/// What the node says of its own health on /diagnostics.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <chrono>
#include <cstdint>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads {

/// Published once a second of wall time: rates, ages, counts of accepted and refused input by reason, model,
/// boom, log health.
class NodeDiagnostics {
 public:
  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const LoadsFlow& flow, const BagLog& log);

  /// An input arrived; its age decides whether the node is stale.
  void crankArrived() { last_crank_ = Clock::now(); }
  void jointStatesArrived() { last_joint_states_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;

  void describeCrank(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describePitch(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describeBoom(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describeFrames(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describeImu(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describeModel(diagnostic_updater::DiagnosticStatusWrapper& status);

  const LoadsFlow& flow_;
  Clock::time_point last_crank_{}, last_joint_states_{}, last_report_{Clock::now()};
  IntakeCounts last_counts_;
  ImuCounts last_imu_counts_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace hammer_loads
