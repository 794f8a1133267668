/// The node's own health on /diagnostics; what is new of it on the console, once.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_thread.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/hammer_bridge.h"

namespace hammer_loads {

/// Published at `~diagnostic_period` (1 s) of wall time: rates, ages, counts of accepted and refused input by reason,
/// model, boom, log health.
class NodeDiagnostics {
 public:
  /// ledger: null where none is kept.
  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const HammerBridge& bridge, const BagLog& log,
                  const life::LedgerThread* ledger);

  /// Topics that should have one publisher each; those without a topic are ignored. They must outlive this or its
  /// reports.
  void watch(std::vector<const ros::Subscriber*> inputs) { inputs_ = std::move(inputs); }
  /// An input arrived; its age decides whether the node is stale.
  void crankArrived() { last_crank_ = Clock::now(); }
  void jointStatesArrived() { last_joint_states_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void report();
  std::vector<Warning> warnings() const;
  void describeInputs(Status& status);
  void describeCrank(Status& status);
  void describePitch(Status& status);
  void describeBoom(Status& status);
  void describeFrames(Status& status);
  void describeImu(Status& status);
  void describeModel(Status& status);
  void describeMisuse(Status& status);

  const HammerBridge& bridge_;
  const BagLog& log_;
  const life::LedgerThread* ledger_;
  std::vector<const ros::Subscriber*> inputs_;
  Clock::time_point last_crank_{}, last_joint_states_{}, last_report_{Clock::now()};
  SampleCounts last_counts_;
  ImuCounts last_imu_counts_;
  std::set<std::string> said_;  ///< keys of warnings on the console already
  LogState log_state_{LogState::kOff};
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace hammer_loads
