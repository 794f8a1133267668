// Readings of a session's sensors on hull and boom: joints, inertial unit, pressures, and the delay of their bus.
#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation {
namespace {

double counted(double value, double count) { return count > 0.0 ? std::round(value / count) * count : value; }

}  // namespace

OnBoomSensors SessionStream::onBoomAt(double time) {
  moveTo(time);
  return std::get<HammerOnBoom>(machine_).sensors();
}

/// Includes the vibration of a boom on its oil.
JointReading SessionStream::readJoints(double time) {
  JointReading reading;
  reading.stamp = busStamp(time, last_joints_);
  for (std::size_t i = 0; i < settings_.boom.size(); ++i) {
    const JointMotion& joint = settings_.boom[i];
    reading.position[i] = positionOf(joint, time), reading.velocity[i] = velocityOf(joint, time);
  }
  if (std::holds_alternative<HammerOnBoom>(machine_)) {
    const OnBoomSensors truth = onBoomAt(time);
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i + 1);
      reading.position[k] = truth.angles[i], reading.velocity[k] = truth.rates[i];
    }
  }
  for (double& angle : reading.position)
    angle = counted(angle + settings_.joint_noise * joint_noise_(), settings_.joint_count);
  for (double& speed : reading.velocity) speed += settings_.joint_speed_noise * joint_noise_();
  return reading;
}

HullImuReading SessionStream::readImu(double time) {
  const OnBoomSensors truth = onBoomAt(time);
  const HullImuSensor& imu = settings_.on_boom.imu;
  HullImuReading reading{busStamp(time, last_imu_), {truth.imu_x, 0.0, truth.imu_z}, {0.0, truth.imu_rate, 0.0}};
  for (double& force : reading.specific_force) force += imu.acceleration_noise * imu_noise_();
  for (double& rate : reading.rate) rate += imu.rate_noise * imu_noise_();
  return reading;
}

PressureReading SessionStream::readPressures(double time) {
  const OnBoomSensors truth = onBoomAt(time);
  PressureReading reading{busStamp(time, last_pressures_), truth.bore_pressure, truth.rod_pressure};
  const PressureSensors& sensor = settings_.on_boom.pressures;
  for (std::size_t k = 0; k < 3 && hoses_[0].isOn(); ++k)
    reading.bore[k] = hoses_[k].output(), reading.rod[k] = hoses_[k + 3].output();
  for (auto* chambers : {&reading.bore, &reading.rod})
    for (double& pressure : *chambers) pressure = counted(pressure + sensor.noise * pressure_noise_(), sensor.count);
  return reading;
}

/// Returns a stamp later than the last one.
std::int64_t SessionStream::busStamp(double time, std::int64_t& last) noexcept {
  const double delay = settings_.on_boom.on ? settings_.on_boom.bus_delay : 0.0;
  const double bus = delay > 0.0 ? delay * bus_draws_.uniform() : 0.0;
  const DriverStamps& driver = settings_.boom_stamps;
  const double late = driver.areExact() ? 0.0 : driver.lateness(time + bus, boom_driver_draws_);
  return last = std::max(last + 1, stampAt(time + bus + late));
}

}  // namespace hammer_loads::simulation
