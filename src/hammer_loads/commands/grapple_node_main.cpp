/// grapple_node: the live grapple.
#include "hammer_loads/grapple_ros/grapple_node.h"
#include "hammer_loads/ros/run_node.h"

namespace {

constexpr char kUsage[] =
    R"(Motion of both jaw edges of a straight-line grapple, live. Needs a ROS master.
Usage: rosrun hammer_loads grapple_node [NAME:=TOPIC]... [_KEY:=VALUE]...
       roslaunch hammer_loads grapple.launch [ARG:=VALUE]...    (--ros-args lists them)

Topic in (remap it with NAME:=TOPIC)
  joint_states  sensor_msgs/JointState  position [m] and velocity [m/s] of the joint `slider_joint`

Topics out (private: below the node's name; JAW is left or right)
  ~jaw_edge/JAW ~jaw_edge/JAW_twist ~jaw_edge/JAW_accel ~mechanism ~run_info (latched)  /diagnostics

Services
  ~log/start ~log/stop ~log/split  std_srvs/Trigger

Parameters (private; SI units, each explained in its file in the package's directory config)
  grapple_claims.yaml  a grapple; none is assumed, every key must be given
  grapple_node.yaml    how samples become jaw edges
  log.yaml             where and how to log

  -h, --help  print this    --version  print the version
)";

}  // namespace

int main(int argc, char** argv) {
  return hammer_loads::runNode(argc, argv, kUsage, "grapple", hammer_loads::makeGrappleNode);
}
