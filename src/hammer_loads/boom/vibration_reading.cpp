#include "hammer_loads/boom/vibration_reading.h"

namespace hammer_loads {
namespace {

VibrationReading emptyReading(Eigen::Index joints) {
  VibrationReading reading;
  reading.displacement = reading.velocity = reading.acceleration = reading.oil = JointVector::Zero(joints);
  return reading;
}

}  // namespace

VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate) {
  VibrationReading reading = emptyReading(J.cols());
  reading.velocity = J.bottomRows<3>().transpose() * n_T;
  reading.value = rate;
  return reading;
}

VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration) {
  VibrationReading reading = emptyReading(J.cols());
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const Eigen::Vector3d v = J.col(j).head<3>(), omega = J.col(j).tail<3>();
    reading.acceleration[j] = n_T.dot(v + omega.cross(p_T));
    // The vibration tilts the sensor: gravity turns against it.
    reading.displacement[j] = n_T.dot(omega.cross(g_T));
  }
  reading.value = acceleration + n_T.dot(g_T);
  return reading;
}

VibrationReading jointAngleReading(int joints, int joint, double angle) {
  VibrationReading reading = emptyReading(joints);
  reading.displacement[joint] = 1.0;
  reading.value = angle;
  return reading;
}

VibrationReading oilTorqueReading(int joints, int joint, double torque) {
  VibrationReading reading = emptyReading(joints);
  reading.oil[joint] = 1.0;
  reading.value = torque;
  return reading;
}

}  // namespace hammer_loads
