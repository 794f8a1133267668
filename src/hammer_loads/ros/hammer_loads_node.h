/// The live node: subscriptions and publications around a HammerBridge. Single-threaded, driven by its input messages.
#pragma once

#include <dynamic_reconfigure/server.h>
#include <hammer_loads/HammerLoadsConfig.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <boost/thread/recursive_mutex.hpp>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/record_clock.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/ros/live_node.h"
#include "hammer_loads/ros/log_services.h"
#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Topics as in the contract. By default one wrench per accepted crank sample, with its stamp. Services `~log/...` and
/// dynamic_reconfigure change what may safely change; each change begins a new run.
class HammerLoadsNode final : public LiveNode {
 public:
  /// log: started already where settings.log.enabled. ledger: null where none is kept.
  HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                  std::unique_ptr<BagLog> log, std::unique_ptr<life::LiveLedger> ledger);
  /// Ends the run and writes the rest to log and ledger.
  ~HammerLoadsNode() override;

 private:
  template <typename Message>
  using Event = ros::MessageEvent<const Message>;

  template <typename Message>
  void subscribe(ros::NodeHandle& node, Input<Message>& input);
  template <typename Message>
  void take(Input<Message>& input, const Event<Message>& event);
  void sayWhatRuns() const;
  void announceRun();
  void beginRun();
  void onReconfigure(HammerLoadsConfig& config);
  void switchLog(bool on);
  void logSwitched();
  HammerLoadsConfig configInForce(bool log_enabled) const;
  ros::Time recordTime(const ros::Time& arrival);

  // A member stands before those that use it: the last members are destroyed first.
  std::unique_ptr<BagLog> log_;
  std::unique_ptr<life::LiveLedger> ledger_;  ///< null: none is kept
  HammerBridge bridge_;
  HammerInputs inputs_;
  RecordClock clock_;
  ros::Publisher run_info_;
  HammerLoadsConfig config_;  ///< in force
  NodeDiagnostics diagnostics_;
  boost::recursive_mutex reconfigure_mutex_;
  dynamic_reconfigure::Server<HammerLoadsConfig> reconfigure_;
  LogServices log_services_;
};

}  // namespace hammer_loads
