#include "hammer_loads/settings/hull_imu_settings.h"

#include <Eigen/Geometry>

namespace hammer_loads {

Eigen::Matrix3d rotationOf(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
          AngleAxisd(roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace hammer_loads
