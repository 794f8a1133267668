/// What an inertial measurement unit on the simulated hull reads.
#pragma once

#include <Eigen/Geometry>
#include <random>

#include "hammer_loads/pipeline/hull_imu.h"

namespace hammer_loads::test {

/// Three-dimensional, without noise.
inline ImuReading readingOf(const HullMotion& hull, const HullImuSettings& mounting) {
  const Eigen::Vector3d rate(0.0, hull.rate, 0.0), acceleration(0.0, hull.acceleration, 0.0);
  const Eigen::Vector3d& r = mounting.position;
  const Eigen::Vector3d force =
      Eigen::Vector3d(-hull.gravity.x, 0.0, -hull.gravity.z) + acceleration.cross(r) + rate.cross(rate.cross(r));
  return {mounting.rotation.transpose() * force, mounting.rotation.transpose() * rate};
}

/// White noise of a good micromechanical unit at 1 kHz: 0.1 m/s2 and 0.003 rad/s.
class ImuNoise {
 public:
  explicit ImuNoise(unsigned seed) : random_(seed) {}
  ImuReading operator()(ImuReading reading) {
    for (int i = 0; i < 3; ++i) {
      reading.specific_force[i] += 0.1 * normal_(random_);
      reading.rate[i] += 0.003 * normal_(random_);
    }
    return reading;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<> normal_;
};

inline HullImuSettings imuMounting() {
  HullImuSettings s;
  s.position = {0.10, 0.15, 0.25};
  s.rotation = rotationOf(3.1, -0.2, 1.5);
  s.max_age = 0.02;
  return s;
}

}  // namespace hammer_loads::test
