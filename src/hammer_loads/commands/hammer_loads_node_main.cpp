/// hammer_loads_node: the live node.
#include "hammer_loads/commands/node_usage.h"
#include "hammer_loads/ros/live_node.h"
#include "hammer_loads/ros/run_node.h"

namespace {

constexpr char kUsage[] =
    R"(Loads of a hydraulic hammer on its hull and boom, live. Needs a ROS master.
Usage: rosrun hammer_loads hammer_loads_node [NAME:=TOPIC]... [_KEY:=VALUE]...
       roslaunch hammer_loads hammer_loads.launch [ARG:=VALUE]...    (--ros-args lists them)

Topics in (remap them with NAME:=TOPIC)
  crank         sensor_msgs/JointState  angle [rad] and speed [rad/s] of the joint `crank_joint`
  joint_states  sensor_msgs/JointState  angles [rad] of the boom's joints
  hull_imu      sensor_msgs/Imu         with hull_motion: imu or boom_stiffness: identified; acceleration less gravity
                                        [m/s2], turning rate [rad/s]
  cylinder_pressures  prefix of NAME/bore and NAME/rod, sensor_msgs/FluidPressure per cylinder: gauge [Pa]
  /tf, /tf_static  where boom_wrench_links names frames outside the boom's chain

Topics out (private: below the node's name)
  ~hull_wrench ~hull_loads ~boom_wrench/LINK ~joint_loads ~section_loads ~joint_reactions ~boom_vibration
  ~mechanism ~pin_forces ~pulse ~blow ~turn_loads ~load_cycles (latched) ~run_info (latched)  /diagnostics

Services
  ~log/start ~log/stop ~log/split  std_srvs/Trigger
  ~set_parameters                  dynamic_reconfigure: log_enabled, output_rate_Hz, tolerance, withhold_above

Parameters (private; SI units, each explained in its file in the package's directory config)
  hammer_mo100.yaml    the hammer; one key given means that all must be
  pipeline.yaml        how samples become loads
  log.yaml             where and how to log
  life.yaml            which load cycles are counted; the ledger that keeps them
  boom_eo2621.yaml     cylinders and supports of a boom; without it the boom is rigid
  robot_description    URDF of the boom; without it there are no loads of the boom

  -h, --help  print this    --version  print the version
)";

}  // namespace

int main(int argc, char** argv) {
  if (const auto code = hammer_loads::answerUsage(argc, argv, kUsage)) return *code;
  return hammer_loads::runNode(argc, argv, "hammer_loads", hammer_loads::makeHammerNode);
}
