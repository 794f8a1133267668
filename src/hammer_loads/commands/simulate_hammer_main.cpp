/// simulate_hammer: a working machine on topics. Parameters: config/simulated_machine.yaml.
#include <ros/init.h>

#include <iostream>
#include <stdexcept>

#include "hammer_loads/ros/machine_player.h"
#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/ros/run_node.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

constexpr char kUsage[] =
    R"(A working excavator with hammer, to try hammer_loads_node with. Needs a ROS master.
Usage: rosrun hammer_loads simulate_hammer [NAME:=TOPIC]... [_KEY:=VALUE]...
       roslaunch hammer_loads demo.launch [ARG:=VALUE]...    (--ros-args lists them)

Topics out
  crank         sensor_msgs/JointState  crank angle [rad] and speed [rad/s]
  joint_states  sensor_msgs/JointState  angles [rad] and speeds [rad/s] of the boom's joints
  hull_imu      sensor_msgs/Imu         with hull_on_boom: acceleration less gravity [m/s2], turning rate [rad/s]
  cylinder_pressures  sensor_msgs/FluidPressure  with hull_on_boom: gauge pressures [Pa] on NAME/bore and NAME/rod below it
  /clock        rosgraph_msgs/Clock     with publish_clock

Parameters (private; SI units, each explained in its file in the package's directory config)
  simulated_machine.yaml  the machine, its sensors, how it is played
  hammer_mo100.yaml       the hammer

  -h, --help  print this    --version  print the version
)";

int run() {
  const ros::NodeHandle private_node("~");
  std::vector<std::string> problems;
  const ParameterMap given = privateParameters(private_node, problems);
  const Checked<simulation::SimulatorSettings> settings = simulation::loadSimulator(configDirectory(), given);
  problems.insert(problems.end(), settings.problems.begin(), settings.problems.end());
  if (settings.value && settings.value->play.publish_clock && !ros::Time::isSimTime())
    problems.emplace_back("publish_clock: true, must be false while /use_sim_time is not true");
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!problems.empty()) return 1;
  for (const std::string& note : settings.notes) ROS_INFO("%s", note.c_str());

  try {
    playMachine(ros::NodeHandle(), *settings.value);
  } catch (const std::runtime_error& error) {
    std::cerr << "truth_prefix: " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  if (const auto code = hammer_loads::answerUsage(argc, argv, hammer_loads::kUsage)) return *code;
  ros::init(argc, argv, "simulate_hammer");
  return hammer_loads::run();
}
