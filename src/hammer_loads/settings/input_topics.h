/// Topics from which a run was computed. A node adds their resolved names to its parameters in `run_info`, so that
/// process_bag finds them in the node's log.
#pragma once

#include <array>
#include <string>

#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {

/// Resolved names; empty: unknown.
struct InputTopics {
  std::string crank, joint_states, hull_imu;
  std::string cylinder_pressures{};  ///< prefix: its topics are /NAME/bore and /NAME/rod below it, per cylinder
  std::string reference{};
};

/// Names of an input.
struct InputName {
  std::string InputTopics::*topic;
  const char* name;      ///< name of a node's topic, to be remapped
  const char* key;       ///< key of the parameters in a run_info
  const char* recorded;  ///< default topic of a bag that states none
  const char* option;    ///< option of the commands that read bags
  const char* holds;     ///< type and content of its messages; lines of a usage text
};

inline constexpr std::array<InputName, 5> kInputs{{
    {&InputTopics::crank, "crank", "input_topic_crank", "/hammer/crank", "--crank-topic",
     "sensor_msgs/JointState  angle [rad] and speed [rad/s] of the joint `crank_joint`"},
    {&InputTopics::joint_states, "joint_states", "input_topic_joint_states", "/joint_states", "--joint-states-topic",
     "sensor_msgs/JointState  angles [rad] of the boom's joints"},
    {&InputTopics::hull_imu, "hull_imu", "input_topic_hull_imu", "/hammer/hull_imu", "--imu-topic",
     "sensor_msgs/Imu         with hull_motion: imu or boom_stiffness: identified; acceleration less gravity\n"
     "                                        [m/s2], turning rate [rad/s]"},
    {&InputTopics::cylinder_pressures, "cylinder_pressures", "input_topic_cylinder_pressures",
     "/hammer/cylinder_pressures", "--pressures-topic",
     "prefix of NAME/bore and NAME/rod, sensor_msgs/FluidPressure per cylinder: gauge [Pa]"},
    {&InputTopics::reference, "reference", "input_topic_reference", "/hammer/reference", "--reference-topic",
     "geometry_msgs/WrenchStamped  a measured load on the hull, as in ~hull_wrench, to compare with; NaN: not "
     "measured"},
}};

/// Returns the names that nameOf() gives for the rows of kInputs.
template <typename NameOf>
InputTopics inputTopics(const NameOf& nameOf) {
  InputTopics topics;
  for (const InputName& input : kInputs) topics.*input.topic = nameOf(input);
  return topics;
}

/// Reads the keys of kInputs, none of which is required.
inline InputTopics readInputTopics(ParameterReader& reader) {
  return inputTopics([&](const InputName& input) { return reader.given(input.key) ? reader.text(input.key) : ""; });
}

}  // namespace hammer_loads
