#include "hammer_loads/ros/grapple_bag_processing.h"

#include "hammer_loads/ros/bag_output.h"

namespace hammer_loads {

GrappleBagSink::GrappleBagSink(rosbag::Bag& bag, const std::string& prefix) : bag_(bag), prefix_(prefix + "/") {}

std::string GrappleBagSink::topic(Jaw jaw, const char* ending) const {
  return prefix_ + "jaw_edge/" + (jaw == Jaw::kLeft ? "left" : "right") + ending;
}

void GrappleBagSink::runInfo(const RunInfo& message, const ros::Time& record_time) {
  writeLatched(bag_, prefix_ + "run_info", record_time, message);
}

void GrappleBagSink::edge(Jaw jaw, const geometry_msgs::PointStamped& message, const ros::Time& record_time) {
  bag_.write(topic(jaw, ""), record_time, message);
}

void GrappleBagSink::twist(Jaw jaw, const geometry_msgs::TwistStamped& message, const ros::Time& record_time) {
  bag_.write(topic(jaw, "_twist"), record_time, message);
}

void GrappleBagSink::accel(Jaw jaw, const geometry_msgs::AccelStamped& message, const ros::Time& record_time) {
  bag_.write(topic(jaw, "_accel"), record_time, message);
}

void GrappleBagSink::mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  bag_.write(prefix_ + "mechanism", record_time, message);
}

std::string refusalReport(const GrappleFlow& flow) {
  std::string report;
  for (const RefusalCount& refusal : flow.refusals()) {
    if (refusal.count == 0) continue;
    report += "slider samples without a jaw edge, " + refusal.reason + ": " + std::to_string(refusal.count);
    report += refusal.last.empty() ? "\n" : "; the last one: " + refusal.last + "\n";
  }
  if (flow.withoutVelocity() > 0)
    report +=
        "slider samples without a velocity, so without twist and accel: " + std::to_string(flow.withoutVelocity()) +
        "\n";
  return report;
}

}  // namespace hammer_loads
