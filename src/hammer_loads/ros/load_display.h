/// Display of the boom's loads in rviz: arrows at their frames, and a line of text on the hammer's work.
#pragma once

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

#include <map>
#include <string>

namespace hammer_loads {

/// Listens to a node hammer_loads. Its run_info gives the places of cuts and joints: each gets a fixed frame,
/// section/NAME or joint/NAME, with the axes in which its load is given. The largest force within each picture's time
/// is shown.
///
/// Out (private): section/NAME and joint/NAME, geometry_msgs/WrenchStamped, and text, visualization_msgs/Marker, with
/// blow rate, energy and peak of the last turn. A joint's load is without its cylinder's.
class LoadDisplay {
 public:
  /// rate: of pictures [Hz], > 0.
  LoadDisplay(ros::NodeHandle& node, ros::NodeHandle& private_node, double rate);

 private:
  struct Shown {
    ros::Publisher publisher;
    geometry_msgs::WrenchStamped largest;
    bool fresh{};
  };

  void onRunInfo(const RunInfo& info);
  void onSections(const SectionLoads& loads);
  void onReactions(const JointReactions& loads);
  void show(const std::string& frame, const ros::Time& stamp, const geometry_msgs::Wrench& load);
  void showText() const;
  void picture();

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

}  // namespace hammer_loads
