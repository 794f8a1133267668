/// The live grapple: subscription and publications around a GrappleFlow. Single-threaded, driven by its input messages.
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/grapple_ros/grapple_diagnostics.h"
#include "hammer_loads/grapple_ros/grapple_flow.h"
#include "hammer_loads/grapple_ros/live_grapple.h"
#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/record_clock.h"
#include "hammer_loads/ros/log_services.h"

namespace hammer_loads {

/// In `joint_states`; out, for each jaw, `~jaw_edge/left`, `~jaw_edge/left_twist`, `~jaw_edge/left_accel`, then
/// `~mechanism`, `~run_info` (latched), /diagnostics. One of each per accepted slider sample, with the sample's stamp.
class GrappleNode final : public LiveNode {
 public:
  /// log: recording, unless nothing shall be logged yet.
  GrappleNode(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleSettings& settings,
              std::unique_ptr<BagLog> log);

 private:
  void beginRun();
  void onJointStates(const ros::MessageEvent<const sensor_msgs::JointState>& event);

  // A member stands before those that use it: the last members are destroyed first.
  std::unique_ptr<BagLog> log_;
  GrappleFlow flow_;
  RecordClock clock_;
  ros::Publisher run_info_;
  GrappleDiagnostics diagnostics_;
  LogServices log_services_;
  ros::Subscriber joint_states_;
  std::string topic_;  ///< topic of joint_states_
};

}  // namespace hammer_loads
