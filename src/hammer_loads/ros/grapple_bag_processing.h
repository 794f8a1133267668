/// The grapple's part of a recorded bag.
#pragma once

#include <rosbag/bag.h>

#include <string>

#include "hammer_loads/ros/grapple_flow.h"

namespace hammer_loads {

/// Writes a GrappleFlow's outputs to a bag.
class GrappleBagSink final : public GrappleSink {
 public:
  /// prefix: of every topic, without / at its end.
  GrappleBagSink(rosbag::Bag& bag, const std::string& prefix);

  void runInfo(const RunInfo& message, const ros::Time& record_time) override;
  void edge(Jaw jaw, const geometry_msgs::PointStamped& message, const ros::Time& record_time) override;
  void twist(Jaw jaw, const geometry_msgs::TwistStamped& message, const ros::Time& record_time) override;
  void accel(Jaw jaw, const geometry_msgs::AccelStamped& message, const ros::Time& record_time) override;
  void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) override;
  bool wants(Jaw) const override { return true; }
  bool wantsMechanism() const override { return true; }

 private:
  std::string topic(Jaw jaw, const char* ending) const;

  rosbag::Bag& bag_;
  std::string prefix_;
};

/// What a user should know of the samples that gave no jaw edge, one line each; empty if all did.
std::string refusalReport(const GrappleFlow& flow);

}  // namespace hammer_loads
