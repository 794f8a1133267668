/// The live grapple: subscription and publications around a GrappleFlow. Single-threaded, driven by its input messages.
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/log/bag_log.h"
#include "hammer_loads/log/record_clock.h"
#include "hammer_loads/ros/grapple_diagnostics.h"
#include "hammer_loads/ros/grapple_flow.h"
#include "hammer_loads/ros/log_services.h"

namespace hammer_loads {

/// In `joint_states`; out, for each jaw, `~jaw_edge/left`, `~jaw_edge/left_twist`, `~jaw_edge/left_accel`, then
/// `~mechanism`, `~run_info` (latched), /diagnostics. One of each per accepted slider sample, with the sample's stamp.
class GrappleNode final : private GrappleSink {
 public:
  /// log: recording, unless nothing shall be logged yet.
  GrappleNode(ros::NodeHandle node, ros::NodeHandle private_node, const GrappleSettings& settings,
              std::unique_ptr<BagLog> log);

 private:
  struct JawPublishers {
    ros::Publisher edge, twist, accel;
  };

  void beginRun();
  void onJointStates(const ros::MessageEvent<const sensor_msgs::JointState>& event);

  void runInfo(const RunInfo& message, const ros::Time& record_time) override;
  void edge(Jaw jaw, const geometry_msgs::PointStamped& message, const ros::Time& record_time) override;
  void twist(Jaw jaw, const geometry_msgs::TwistStamped& message, const ros::Time& record_time) override;
  void accel(Jaw jaw, const geometry_msgs::AccelStamped& message, const ros::Time& record_time) override;
  void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) override;
  bool wants(Jaw jaw) const override;
  bool wantsMechanism() const override;

  template <typename Message>
  void send(const ros::Publisher& publisher, const Message& message, const ros::Time& record_time);
  const JawPublishers& publishers(Jaw jaw) const { return jaws_[static_cast<std::size_t>(jaw)]; }

  GrappleFlow flow_;
  std::unique_ptr<BagLog> log_;
  std::array<JawPublishers, kJaws.size()> jaws_;  // by Jaw
  ros::Publisher mechanism_, run_info_;
  ros::Subscriber joint_states_;
  RecordClock clock_;
  GrappleDiagnostics diagnostics_;
  LogServices log_services_;
};

/// Node from its private parameters; every problem is reported on one line each and gives no node.
std::unique_ptr<GrappleNode> makeGrappleNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                             std::vector<std::string>& problems);

}  // namespace hammer_loads
