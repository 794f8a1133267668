/// The live node: subscriptions and publications around a LoadsFlow. Single-threaded, driven by its input messages.
#pragma once

#include <dynamic_reconfigure/server.h>
#include <hammer_loads/HammerLoadsConfig.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <boost/thread/recursive_mutex.hpp>
#include <map>
#include <memory>
#include <string>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/record_clock.h"
#include "hammer_loads/ros/loads_flow.h"
#include "hammer_loads/ros/log_services.h"
#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

/// Topics as in the contract. By default one wrench per accepted crank sample, with its stamp. Services `~log/...` and
/// dynamic_reconfigure change what may safely change; each change begins a new run.
class HammerLoadsNode final : private LoadsSink {
 public:
  /// log: started already where settings.log.enabled.
  HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                  std::unique_ptr<BagLog> log);

 private:
  template <typename Message>
  using Event = ros::MessageEvent<const Message>;
  using JointState = sensor_msgs::JointState;

  void subscribe(ros::NodeHandle& node);
  void announceRun();
  void beginRun();
  void onReconfigure(HammerLoadsConfig& config);
  void switchLog(bool on);
  void logSwitched();
  HammerLoadsConfig configInForce(bool log_enabled) const;
  void onCrank(const Event<JointState>& event);
  void onJointStates(const Event<JointState>& event);
  void onImu(const Event<sensor_msgs::Imu>& event);
  void onTransforms(const Event<tf2_msgs::TFMessage>& event, bool is_static);
  ros::Time recordTime(const ros::Time& arrival);

  void runInfo(const RunInfo& message, const ros::Time& record_time) override;
  void hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) override;
  void boomWrench(const std::string& link, const geometry_msgs::WrenchStamped& message,
                  const ros::Time& record_time) override;
  void jointLoads(const JointLoads& message, const ros::Time& record_time) override;
  void boomVibration(const BoomVibration& message, const ros::Time& record_time) override;
  void hullLoads(const HullLoads& message, const ros::Time& record_time) override;
  void mechanism(const JointState& message, const ros::Time& record_time) override;
  void pinForces(const PinForces& message, const ros::Time& record_time) override;
  void blow(const Blow& message, const ros::Time& record_time) override;
  void pulse(const Pulse& message, const ros::Time& record_time) override;
  bool wantsBoomWrench(const std::string& link) const override { return wanted(boom_wrench_.at(link)); }
  bool wantsJointLoads() const override { return wanted(joint_loads_); }
  bool wantsBoomVibration() const override { return wanted(boom_vibration_); }
  bool wantsHullLoads() const override { return wanted(hull_loads_); }
  bool wantsMechanism() const override { return wanted(mechanism_); }
  /// Not logged: they follow from the logged mechanism and would be the largest part of the log.
  bool wantsPinForces() const override { return pin_forces_.getNumSubscribers() > 0; }
  bool wantsTurns() const override { return wanted(blow_) || wanted(pulse_); }

  bool wanted(const ros::Publisher& publisher) const {
    return log_->isRecording() || publisher.getNumSubscribers() > 0;
  }
  template <typename Message>
  void send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time);

  LoadsFlow flow_;
  std::unique_ptr<BagLog> log_;
  ros::Publisher hull_wrench_, hull_loads_, joint_loads_, boom_vibration_, mechanism_, pin_forces_, blow_, pulse_,
      run_info_;
  std::map<std::string, ros::Publisher> boom_wrench_;  ///< by link
  ros::Subscriber joint_states_, crank_, hull_imu_, tf_, tf_static_;
  bool one_topic_{};  ///< crank and joint states arrive on the same topic
  RecordClock clock_;
  NodeDiagnostics diagnostics_;
  HammerLoadsConfig config_;  ///< in force
  boost::recursive_mutex reconfigure_mutex_;
  dynamic_reconfigure::Server<HammerLoadsConfig> reconfigure_;
  LogServices log_services_;
};

/// Node from its private parameters; every problem is reported on one line each and gives no node.
std::unique_ptr<HammerLoadsNode> makeNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems);

}  // namespace hammer_loads
