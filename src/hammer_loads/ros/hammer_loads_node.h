/// The live node: subscriptions and publications around a LoadsFlow. Single-threaded, driven by its input messages.
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <memory>

#include "hammer_loads/parameters/load.h"
#include "hammer_loads/ros/bag_log.h"
#include "hammer_loads/ros/loads_flow.h"
#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/ros/record_clock.h"

namespace hammer_loads {

/// Topics as in the contract: in `crank`, `joint_states`; out `~hull_wrench`, `~hull_loads`, `~mechanism`, `~pin_forces`, `~blow`,
/// `~pulse`, `~run_info` (latched), /diagnostics. By default one wrench per accepted crank sample, with its stamp.
class HammerLoadsNode final : private LoadsSink {
 public:
  /// log: null when nothing shall be logged.
  HammerLoadsNode(ros::NodeHandle node, ros::NodeHandle private_node, const Settings& settings,
                  std::unique_ptr<BagLog> log);

 private:
  using JointStateEvent = ros::MessageEvent<const sensor_msgs::JointState>;

  void onCrank(const JointStateEvent& event);
  void onJointStates(const JointStateEvent& event);
  ros::Time recordTime(const JointStateEvent& event);

  void runInfo(const RunInfo& message, const ros::Time& record_time) override;
  void hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) override;
  void hullLoads(const HullLoads& message, const ros::Time& record_time) override;
  void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) override;
  void pinForces(const PinForces& message, const ros::Time& record_time) override;
  void blow(const Blow& message, const ros::Time& record_time) override;
  void pulse(const Pulse& message, const ros::Time& record_time) override;
  bool wantsHullLoads() const override;
  bool wantsMechanism() const override;
  bool wantsPinForces() const override;
  bool wantsTurns() const override;

  template <typename Message>
  void send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time);

  LoadsFlow flow_;
  std::unique_ptr<BagLog> log_;
  ros::Publisher hull_wrench_, hull_loads_, mechanism_, pin_forces_, blow_, pulse_, run_info_;
  ros::Subscriber joint_states_, crank_;
  bool one_topic_{};       ///< crank and joint states arrive on the same topic
  RecordClock clock_;
  NodeDiagnostics diagnostics_;
};

/// Node from its private parameters; every problem is reported on one line each and gives no node.
std::unique_ptr<HammerLoadsNode> makeNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                          std::vector<std::string>& problems);

}  // namespace hammer_loads
