/// Place of an inertial measurement unit on the hull.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

struct HullImuSettings {
  Eigen::Vector3d position{0.0, 0.0, 0.0};                ///< from D, axes of hammer_hull [m]
  double position_std{};                                  ///< standard deviation of each of them [m]
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};  ///< from the unit's axes to those of hammer_hull
  double max_age{};  ///< largest age of the last reading [s], > 0; beyond it the motion is not known
};

/// Rotation by roll, pitch, yaw about fixed x, y, z [rad], as in a URDF origin.
Eigen::Matrix3d rotationOf(double roll, double pitch, double yaw);

}  // namespace hammer_loads
