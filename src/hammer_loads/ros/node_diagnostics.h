/// Health of the node on /diagnostics, and new warnings on the console, once each.
#pragma once

#include <ros/node_handle.h>

#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/ros/diagnostics_publisher.h"
#include "hammer_loads/ros/hammer_inputs.h"

namespace hammer_loads {

/// Key in the crank's status: header stamp of the last sample that the node has taken [ns].
inline constexpr char kLastSampleKey[] = "header stamp of the last sample [ns]";

/// Reporter of rates and ages, counts of accepted and refused input by reason, model, boom and health of the log.
class NodeDiagnostics {
 public:
  /// inputs: each input of a sensor should have one publisher; the age of the crank's input decides whether the node is
  /// stale. ledger: null if none is kept.
  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const HammerBridge& bridge, HammerInputs& inputs,
                  BagLog& log, const RecordClock& clock, const life::LiveLedger* ledger);

 private:
  using Clock = std::chrono::steady_clock;
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void warnOnConsole();
  std::vector<Warning> warnings();
  void describeInputs(Status& status);
  void describeCrank(Status& status);
  void describePitch(Status& status);
  void describeBoom(Status& status);
  void describeFrames(Status& status);
  void describeImu(Status& status);
  void describeModel(Status& status);
  void describeMisuse(Status& status);
  void describeLife(Status& status);
  void describeLimits(Status& status);
  void describeReference(Status& status);
  /// Returns a warning if the ledger cannot accept pieces at present.
  std::optional<Warning> ledgerWarning() const;

  const HammerBridge& bridge_;
  HammerInputs& inputs_;
  const BagLog& log_;
  const life::LiveLedger* ledger_;
  Clock::time_point last_report_{Clock::now()};
  SampleCounts last_counts_;
  ImuCounts last_imu_counts_;
  std::set<std::string> stated_;   ///< keys of warnings already on the console
  std::set<std::string> awaited_;  ///< keys of inputs that were missing at the last report
  LogState log_state_{LogState::kOff};
  DiagnosticsPublisher publisher_;
};

}  // namespace hammer_loads
