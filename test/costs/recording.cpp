// Records the shipped machine at work on its boom for any length of time: crank and IMU at 1 kHz, pressures at 200 Hz
// and joints at 50 Hz, on the topics of the launch files. Usage: recording OUT.bag SECONDS
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <cstdlib>
#include <iostream>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/log/bag_writer.h"

namespace hammer_loads {
namespace {

ros::Time timeOf(std::int64_t stamp) { return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp)); }

class Recording {
 public:
  explicit Recording(const std::string& path) : bag_(path) {}

  void write(const simulation::CrankReading& reading) {
    sensor_msgs::JointState m;
    m.name = {"hammer_crank_joint"}, m.position = {reading.angle}, m.velocity = {*reading.speed};
    send("/hammer/crank", reading.stamp, m);
  }
  void write(const simulation::JointReading& reading) {
    sensor_msgs::JointState m;
    m.name.assign(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
    m.position.assign(reading.position.begin(), reading.position.end());
    m.velocity.assign(reading.velocity.begin(), reading.velocity.end());
    send("/joint_states", reading.stamp, m);
  }
  void write(const simulation::HullImuReading& reading) {
    sensor_msgs::Imu m;
    const auto &a = reading.specific_force, &w = reading.rate;
    m.linear_acceleration.x = a[0], m.linear_acceleration.y = a[1], m.linear_acceleration.z = a[2];
    m.angular_velocity.x = w[0], m.angular_velocity.y = w[1], m.angular_velocity.z = w[2];
    send("/hammer/hull_imu", reading.stamp, m);
  }
  void write(const simulation::PressureReading& reading) {
    sensor_msgs::FluidPressure m;
    for (std::size_t i = 0; i < simulation::kBoomCylinders.size(); ++i) {
      const std::string topic = std::string("/hammer/cylinder_pressures/") + simulation::kBoomCylinders[i];
      m.fluid_pressure = reading.bore[i];
      send(topic + "/bore", reading.stamp, m);
      m.fluid_pressure = reading.rod[i];
      send(topic + "/rod", reading.stamp, m);
    }
  }
  void close() { bag_.close(); }

 private:
  template <typename Message>
  void send(const std::string& topic, std::int64_t stamp, Message& message) {
    message.header.stamp = timeOf(stamp);
    bag_.write(topic, message.header.stamp, message);
  }

  BagWriter bag_;
};

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  using namespace hammer_loads;
  const int seconds = argc == 3 ? std::atoi(argv[2]) : 0;
  if (seconds < 1) return std::cerr << "usage: recording OUT.bag SECONDS\n", 1;
  simulation::MachineSettings machine = accuracy::machineOnBoom(seconds);
  machine.on_boom.pressures.rate = 200.0;
  simulation::SessionStream stream(machine);
  Recording recording(argv[1]);
  for (int second = 1; second <= seconds; ++second) {
    simulation::Session piece;
    stream.advanceTo(second, piece);
    for (const auto& reading : piece.joints) recording.write(reading);
    for (const auto& reading : piece.crank) recording.write(reading);
    for (const auto& reading : piece.imu) recording.write(reading);
    for (const auto& reading : piece.pressures) recording.write(reading);
  }
  recording.close();
}
