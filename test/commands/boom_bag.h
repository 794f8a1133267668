/// A bag of a machine on its boom as it would be recorded, and process_bag on it with a robot description.
#pragma once

#include <sensor_msgs/FluidPressure.h>
#include <tf2_msgs/TFMessage.h>

#include "commands/bag_files.h"
#include "commands/recording_sink.h"
#include "hammer_loads/ros/stamp.h"
#include "support/known_zero.h"
#include "support/session_player.h"

namespace hammer_loads::test {

inline constexpr double kSide = 0.8;  // [m] from arm_link back to the strain gauge
inline const std::string kUrdf = sourceFile("urdf/eo2621_mo100.urdf");
/// The encoder's zero is known as by `calibrate`: else samples of the first turns are withheld.
inline const std::string kCalibrated = kKnownZeroYaml;
inline const std::string kBoomFile = configDirectory() + "/boom_eo2621.yaml";

/// Two and a half seconds of a machine that soon strikes; `moving`: its boom moves as well.
inline simulation::MachineSettings machineOfBag(bool moving) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 2.5;
  machine.drive.start_time = 0.1;
  machine.drive.start_ramp = 0.2;
  for (simulation::JointMotion& joint : machine.boom) joint.amplitude *= moving ? 1.0 : 0.0;
  return machine;
}

inline geometry_msgs::TransformStamped transform(const ros::Time& stamp, const std::string& parent,
                                                 const std::string& child, double x, double z, double pitch = 0.0) {
  geometry_msgs::TransformStamped t;
  t.header.stamp = stamp;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.transform.translation.x = x;
  t.transform.translation.z = z;
  t.transform.rotation.y = std::sin(0.5 * pitch);
  t.transform.rotation.w = std::cos(0.5 * pitch);
  return t;
}

/// Inputs of a session as they would be recorded, 2 ms late.
class InputBag {
 public:
  InputBag(const std::string& path, const simulation::Session& session) : bag_(path, rosbag::bagmode::Write) {
    writeStatic(session.joints.front().stamp);
    for (const simulation::JointReading& reading : session.joints) writeJoints(reading);
    for (const simulation::CrankReading& reading : session.crank) {
      sensor_msgs::JointState m;
      m.header.stamp = timeOf(reading.stamp);
      m.name = {"hammer_crank_joint"};
      m.position = {reading.angle};
      m.velocity = {*reading.speed};
      write("/hammer/crank", m.header.stamp, m);
    }
  }
  void writePressures(const ros::Time& stamp, const std::string& cylinder, double bore, double rod) {
    sensor_msgs::FluidPressure m;
    m.header.stamp = stamp;
    m.fluid_pressure = bore;
    write("/machine/oil/" + cylinder + "/bore", stamp, m);
    m.fluid_pressure = rod;
    write("/machine/oil/" + cylinder + "/rod", stamp, m);
  }
  void writeImu(const ros::Time& stamp, const ImuReading& reading) {
    sensor_msgs::Imu m;
    m.header.stamp = stamp;
    m.linear_acceleration.x = reading.specific_force.x();
    m.linear_acceleration.y = reading.specific_force.y();
    m.linear_acceleration.z = reading.specific_force.z();
    m.angular_velocity.y = reading.rate.y();
    write("/machine/imu", stamp, m);
  }

 private:
  template <typename Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_.write(topic, stamp + ros::Duration(0.002), message);
  }
  void writeStatic(StampNs first) {
    tf2_msgs::TFMessage m;
    m.transforms = {transform({}, "hammer_link", "hammer_hull", 0.10, -0.55),
                    transform({}, "arm_link", "strain_gauge", -kSide, 0.0)};
    write("/tf_static", timeOf(first), m);
  }
  void writeJoints(const simulation::JointReading& reading) {
    sensor_msgs::JointState joints;
    joints.header.stamp = timeOf(reading.stamp);
    joints.name.assign(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
    joints.position.assign(reading.position.begin(), reading.position.end());
    joints.velocity.assign(reading.velocity.begin(), reading.velocity.end());
    write("/joint_states", joints.header.stamp, joints);
    tf2_msgs::TFMessage m;
    m.transforms = {transform(joints.header.stamp, "arm_link", "hammer_link", 1.70, 0.0, reading.position[3])};
    write("/tf", joints.header.stamp, m);
  }

  rosbag::Bag bag_;
};

class BoomBag : public BagFiles {
 protected:
  Outcome process(const std::string& out, const std::string& parameters, const std::string& more = {}) const {
    const TemporaryFile given(kCalibrated + parameters);
    return runCommand(HAMMER_LOADS_PROCESS_BAG, path("in.bag") + " " + path(out) + " --pins --urdf " + kUrdf +
                                                    " --params " + kBoomFile + " --params " + given.path() + " " +
                                                    more);
  }
  /// What the live node's flow makes of the same messages.
  Recorded live(const std::string& parameters, const std::string& imu_topic = {}) const {
    const TemporaryFile given(kCalibrated + parameters);
    const Settings settings = *loadFiles(configDirectory(), {kBoomFile, given.path()}, textOf(kUrdf)).value;
    const InputTopics topics{"/hammer/crank", "/joint_states", imu_topic.empty() ? "/hammer/hull_imu" : imu_topic,
                             "/hammer/cylinder_pressures", "/hammer/reference"};
    return recordedLive(path("in.bag"), withInputTopics(settings, topics), imu_topic);
  }
};

}  // namespace hammer_loads::test
