/// simulate_grapple: a slider that opens and closes a grapple for ever, on topic `joint_states`.
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/rate.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <iostream>

#include "hammer_loads/grapple/grapple_settings.h"
#include "hammer_loads/ros/ros_parameters.h"
#include "hammer_loads/ros/run_node.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr char kUsage[] =
    R"(The slider of a grapple that opens and closes for ever, to try grapple_node with. Needs a ROS master.
Usage: rosrun hammer_loads simulate_grapple [joint_states:=TOPIC] _KEY:=VALUE...
       roslaunch hammer_loads grapple.launch demo:=true

Topic out
  joint_states  sensor_msgs/JointState  position [m] and velocity [m/s] of the slider

Parameters (private)
  config/grapple_claims.yaml  the grapple, every key
  slider_joint                name of the joint
  period_s                    of opening and closing together [s], > 0
  rate_Hz                     samples a second [Hz], > 0

  -h, --help  print this    --version  print the version
)";

/// period: of opening and closing together [s]; samples_per_second [Hz].
void play(const GrappleParameters& grapple, const std::string& joint, double period, double samples_per_second) {
  ros::NodeHandle node;
  const ros::Publisher publisher = node.advertise<sensor_msgs::JointState>("joint_states", 100);
  const double turn = kTwoPi / period, half = 0.5 * (grapple.slider_closed - grapple.slider_open);
  sensor_msgs::JointState message;
  message.name = {joint};
  ros::WallRate rate(samples_per_second);  // differences of ROS times end the node where they are beyond 68 years
  for (const double start = ros::Time::now().toSec(); ros::ok(); rate.sleep()) {
    message.header.stamp = ros::Time::now();
    const double phase = turn * (message.header.stamp.toSec() - start);
    message.position = {grapple.slider_open + half * (1.0 + std::cos(phase))};
    message.velocity = {-turn * half * std::sin(phase)};
    publisher.publish(message);
  }
}

int run() {
  std::vector<std::string> problems;
  ParameterReader reader(privateParameters(ros::NodeHandle("~"), problems));
  const std::optional<Grapple> grapple = readGrapple(reader);
  const std::string joint = reader.text("slider_joint");
  const double period = reader.number("period_s", "s", NumberRule::positive());
  const double rate = reader.number("rate_Hz", "Hz", NumberRule::positive());
  reader.reportUnknownKeys();
  problems.insert(problems.end(), reader.problems().begin(), reader.problems().end());
  for (const std::string& problem : problems) std::cerr << problem << '\n';
  if (!grapple || !problems.empty()) return 1;
  play(grapple->parameters(), joint, period, rate);
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  if (const auto code = hammer_loads::answerUsage(argc, argv, hammer_loads::kUsage)) return *code;
  ros::init(argc, argv, "simulate_grapple");
  return hammer_loads::run();
}
