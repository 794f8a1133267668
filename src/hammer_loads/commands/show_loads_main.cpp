/// show_loads: what rviz draws of the boom's loads.
#include <memory>

#include "hammer_loads/commands/node_usage.h"
#include "hammer_loads/ros/load_display.h"
#include "hammer_loads/ros/run_node.h"

namespace hammer_loads {
namespace {

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
  if (const auto code = hammer_loads::answerUsage(argc, argv, hammer_loads::kUsage)) return *code;
  return hammer_loads::runNode(argc, argv, "show_loads", hammer_loads::make);
}
