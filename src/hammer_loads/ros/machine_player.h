/// Player of a simulated machine on topics, in real time or in simulated time, with files of the true values.
#pragma once

#include <ros/node_handle.h>

#include "hammer_loads/simulation/machine_parameters.h"

namespace hammer_loads {

/// Plays on the topics crank (hammer_crank_joint) and joint_states, both sensor_msgs/JointState. A hull on its boom
/// also has hull_imu, sensor_msgs/Imu, and cylinder_pressures/NAME/bore and /rod, sensor_msgs/FluidPressure. Stamps are
/// the instants of sampling. Batches are a millisecond long, so a sample is at most about that old when it is sent.
/// Time follows
/// - the steady clock from the wall time of the start, without /use_sim_time;
/// - /clock, with /use_sim_time; the machine restarts if it jumps back;
/// - its own steps, with /use_sim_time and publish_clock; /clock is then published before the samples up to it.
/// Unless it follows /clock, it adapts to the computer: a batch is at most 5 ms long, and the machine pauses while the
/// diagnostics of the receiving node are 2 s behind. Its time is then slower than the wall clock. It ends when that
/// node has processed the last sample, or when ROS shuts down. Throws std::runtime_error if a file of the true values
/// cannot be written.
void playMachine(ros::NodeHandle node, const simulation::SimulatorSettings& settings);

}  // namespace hammer_loads
