/// show_loads: what rviz draws of the boom's loads.
#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/JointReactions.h>
#include <hammer_loads/Pulse.h>
#include <hammer_loads/RunInfo.h>
#include <hammer_loads/SectionLoads.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/timer.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "hammer_loads/ros/run_node.h"
#include "hammer_loads/settings/load.h"
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

/// Listens to a node hammer_loads. Its run_info gives the places of cuts and joints: each gets a fixed frame,
/// section/NAME or joint/NAME, with the axes in which its load is given. The largest force within each picture's time
/// is shown.
///
/// Out (private): section/NAME and joint/NAME, geometry_msgs/WrenchStamped, and text, visualization_msgs/Marker, with
/// blow rate, energy and peak of the last turn. A joint's load is without its cylinder's.
class LoadDisplay {
 public:
  /// rate: of pictures [Hz], > 0.
  LoadDisplay(ros::NodeHandle& node, ros::NodeHandle& private_node, double rate)
      : private_node_(private_node), text_(private_node.advertise<visualization_msgs::Marker>("text", 1, true)) {
    run_info_ = node.subscribe("hammer_loads/run_info", 1, &LoadDisplay::onRunInfo, this);
    sections_ = node.subscribe("hammer_loads/section_loads", kQueue, &LoadDisplay::onSections, this);
    reactions_ = node.subscribe("hammer_loads/joint_reactions", kQueue, &LoadDisplay::onReactions, this);
    pulses_ = node.subscribe<Pulse>("hammer_loads/pulse", kQueue, [this](const Pulse::ConstPtr& m) { pulse_ = *m; });
    blows_ = node.subscribe<Blow>("hammer_loads/blow", kQueue, [this](const Blow::ConstPtr& m) { blow_ = *m; });
    timer_ = node.createWallTimer(ros::WallDuration(1.0 / rate), [this](const ros::WallTimerEvent&) { picture(); });
  }

 private:
  struct Shown {
    ros::Publisher publisher;
    std::optional<geometry_msgs::WrenchStamped> largest;  ///< since the last picture
  };

  void onRunInfo(const RunInfo& info) {
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
  void onSections(const SectionLoads& loads) {
    for (const SectionLoad& section : loads.section) show("section/" + section.name, loads.header.stamp, section.load);
  }
  void onReactions(const JointReactions& loads) {
    for (const JointReaction& joint : loads.joint) show("joint/" + joint.name, loads.header.stamp, joint.load);
  }
  /// At a zero moment arm a load is not a number: no arrow.
  void show(const std::string& frame, const ros::Time& stamp, const geometry_msgs::Wrench& load) {
    const auto found = shown_.find(frame);
    if (found == shown_.end() || !std::isfinite(sizeOf(load.force)) || !std::isfinite(sizeOf(load.torque))) return;
    Shown& shown = found->second;
    if (shown.largest && sizeOf(load.force) <= sizeOf(shown.largest->wrench.force)) return;
    shown.largest.emplace();
    shown.largest->header.stamp = stamp;
    shown.largest->header.frame_id = frame;
    shown.largest->wrench = load;
  }
  void picture() {
    for (auto& [frame, shown] : shown_) {
      if (shown.largest) shown.publisher.publish(*shown.largest);
      shown.largest.reset();
    }
    if (!root_.empty()) showText();
  }
  void showText() const {
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

  ros::NodeHandle private_node_;
  std::map<std::string, Shown> shown_;  ///< by frame
  std::string root_;                    ///< frame of the text; empty before a run_info
  Pulse pulse_;
  Blow blow_;
  tf2_ros::StaticTransformBroadcaster frames_;
  ros::Publisher text_;
  ros::Subscriber run_info_, sections_, reactions_, pulses_, blows_;
  ros::WallTimer timer_;  ///< wall time, since a timer of ROS time ends the node at the end of that time
};

constexpr char kUsage[] =
    R"(Arrows and text for rviz from the outputs of a node hammer_loads. Needs a ROS master.
Usage: rosrun hammer_loads show_loads [NAME:=TOPIC]... [_rate_Hz:=RATE]
       roslaunch hammer_loads hammer_loads.launch rviz:=true ...    starts it

Topics in
  hammer_loads/run_info hammer_loads/section_loads hammer_loads/joint_reactions hammer_loads/pulse hammer_loads/blow

Topics out (private)
  ~section/NAME ~joint/NAME  geometry_msgs/WrenchStamped  largest force of each picture's time, at a frame of that name
  ~text                      visualization_msgs/Marker    blow rate, energy, peak of the last turn
  /tf_static                 the frames section/NAME and joint/NAME

Parameters (private)
  rate_Hz  pictures per second, 30 if not given

  -h, --help  print this    --version  print the version
)";

std::unique_ptr<LoadDisplay> make(ros::NodeHandle& node, ros::NodeHandle& private_node,
                                  std::vector<std::string>& problems) {
  const double rate = private_node.param("rate_Hz", 30.0);
  if (rate > 0.0 && rate <= 1000.0) return std::make_unique<LoadDisplay>(node, private_node, rate);
  problems.push_back("rate_Hz: must be in (0, 1000] Hz");
  return nullptr;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  return hammer_loads::runNode(argc, argv, hammer_loads::kUsage, "show_loads", hammer_loads::make);
}
