#include "hammer_loads/boom/vibration_reading.h"

namespace hammer_loads {
namespace {

VibrationReading emptyReading(double value) {
  VibrationReading reading;
  for (auto* row : {&reading.displacement, &reading.velocity, &reading.acceleration}) row->setZero();
  reading.value = value;
  return reading;
}

}  // namespace

VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate) {
  VibrationReading reading = emptyReading(rate);
  for (Eigen::Index j = 0; j < J.cols(); ++j) reading.velocity[j] = n_T.dot(J.col(j).tail<3>());
  return reading;
}

VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration) {
  VibrationReading reading = emptyReading(acceleration + n_T.dot(g_T));
  // n . (v + omega x p) and n . (omega x g), where the vibration tilts the sensor and gravity turns against it.
  const Eigen::Vector3d p_n = p_T.cross(n_T), g_n = g_T.cross(n_T);
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const auto omega = J.col(j).tail<3>();
    reading.acceleration[j] = n_T.dot(J.col(j).head<3>()) + omega.dot(p_n);
    reading.displacement[j] = omega.dot(g_n);
  }
  return reading;
}

VibrationReading jointAngleReading(int joint, double angle) {
  VibrationReading reading = emptyReading(angle);
  reading.displacement[joint] = 1.0;
  return reading;
}

VibrationReading oilTorqueReading(int joint, double torque) {
  VibrationReading reading;
  reading.of_oil = true;
  reading.oil.setZero();
  reading.oil[joint] = 1.0;
  reading.value = torque;
  return reading;
}

}  // namespace hammer_loads
