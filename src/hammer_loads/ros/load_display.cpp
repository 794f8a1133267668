#include "hammer_loads/ros/load_display.h"

#include <visualization_msgs/Marker.h>

#include <cmath>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/recorded_settings.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::uint32_t kQueue = 10000;
constexpr double kTextHeight = 0.22, kTextUp = 2.9, kTextAhead = 1.3;  // [m], place in the boom's root

double sizeOf(const geometry_msgs::Vector3& v) { return std::hypot(v.x, v.y, v.z); }

geometry_msgs::TransformStamped frameOf(const std::string& name, const std::string& parent, const Pose& pose) {
  geometry_msgs::TransformStamped frame;
  frame.header.stamp = ros::Time::now();
  frame.header.frame_id = parent;
  frame.child_frame_id = name;
  const Eigen::Vector3d& p = pose.translation();
  frame.transform.translation.x = p.x(), frame.transform.translation.y = p.y(), frame.transform.translation.z = p.z();
  const Eigen::Quaterniond q(pose.linear());
  frame.transform.rotation.x = q.x(), frame.transform.rotation.y = q.y();
  frame.transform.rotation.z = q.z(), frame.transform.rotation.w = q.w();
  return frame;
}

}  // namespace

LoadDisplay::LoadDisplay(ros::NodeHandle& node, ros::NodeHandle& private_node, double rate)
    : private_node_(private_node), text_(private_node.advertise<visualization_msgs::Marker>("text", 1, true)) {
  run_info_ = node.subscribe("hammer_loads/run_info", 1, &LoadDisplay::onRunInfo, this);
  sections_ = node.subscribe("hammer_loads/section_loads", kQueue, &LoadDisplay::onSections, this);
  reactions_ = node.subscribe("hammer_loads/joint_reactions", kQueue, &LoadDisplay::onReactions, this);
  pulses_ = node.subscribe<Pulse>("hammer_loads/pulse", kQueue, [this](const Pulse::ConstPtr& m) { pulse_ = *m; });
  blows_ = node.subscribe<Blow>("hammer_loads/blow", kQueue, [this](const Blow::ConstPtr& m) { blow_ = *m; });
  timer_ = node.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { picture(); });
}

void LoadDisplay::onRunInfo(const RunInfo& info) {
  const Checked<Settings> settings = loadRecorded(configDirectory(), info.parameters_yaml, info.robot_description);
  if (!settings.value || !settings.value->boom) {
    ROS_WARN("run_info of hammer_loads has no boom: there are no loads to show");
    return;
  }
  const Boom& boom = *settings.value->boom;
  const Chain& chain = boom.chain();
  std::vector<geometry_msgs::TransformStamped> frames;
  for (const Section& section : boom.sections())
    frames.push_back(frameOf("section/" + section.name(), chain.link(section.link()).name, section.poseInLink()));
  for (int j = 0; j < chain.joints(); ++j) {
    const int beyond = chain.linkBeyond(j);
    const Pose origin(Eigen::Translation3d(chain.link(beyond).origin));
    frames.push_back(
        frameOf("joint/" + chain.jointNames()[static_cast<std::size_t>(j)], chain.link(beyond - 1).name, origin));
  }
  for (const auto& frame : frames) {
    Shown& shown = shown_[frame.child_frame_id];
    if (!shown.publisher)
      shown.publisher = private_node_.advertise<geometry_msgs::WrenchStamped>(frame.child_frame_id, 10);
  }
  root_ = chain.link(0).name;
  frames_.sendTransform(frames);
}

void LoadDisplay::onSections(const SectionLoads& loads) {
  for (const SectionLoad& section : loads.section) show("section/" + section.name, loads.header.stamp, section.load);
}

void LoadDisplay::onReactions(const JointReactions& loads) {
  for (const JointReaction& joint : loads.joint) show("joint/" + joint.name, loads.header.stamp, joint.load);
}

/// At a zero moment arm a load is not a number: no arrow.
void LoadDisplay::show(const std::string& frame, const ros::Time& stamp, const geometry_msgs::Wrench& load) {
  const auto found = shown_.find(frame);
  if (found == shown_.end() || !std::isfinite(sizeOf(load.force)) || !std::isfinite(sizeOf(load.torque))) return;
  Shown& shown = found->second;
  if (shown.fresh && sizeOf(load.force) <= sizeOf(shown.largest.wrench.force)) return;
  shown.largest.header.stamp = stamp;
  shown.largest.header.frame_id = frame;
  shown.largest.wrench = load;
  shown.fresh = true;
}

void LoadDisplay::picture() {
  for (auto& [frame, shown] : shown_) {
    if (shown.fresh) shown.publisher.publish(shown.largest);
    shown.fresh = false;
  }
  if (!root_.empty()) showText();
}

void LoadDisplay::showText() const {
  visualization_msgs::Marker text;
  text.header.frame_id = root_;  // no stamp: the newest transform
  text.ns = "hammer";
  text.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  text.pose.position.x = kTextAhead, text.pose.position.z = kTextUp;
  text.pose.orientation.w = 1.0;
  text.scale.z = kTextHeight;
  text.color.a = 1.0, text.color.r = text.color.g = text.color.b = 0.15F;
  text.text = pulse_.period > 0.0 ? format("%.2f blows/s   %.0f J   peak %.1f kN", 1.0 / pulse_.period, blow_.energy,
                                           1e-3 * pulse_.amplitude)
                                  : "no blow yet";
  text_.publish(text);
}

}  // namespace hammer_loads
