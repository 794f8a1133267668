/// The crank filter's settings as shipped, for the MO-100's rocker; count and noise of the angle as a test wants them.
#pragma once

#include "hammer_loads/crank/crank_filter.h"

namespace hammer_loads::test {

inline CrankFilterSettings filterSettings(double angle_resolution = 0.0, double angle_noise = 0.0) {
  CrankFilterSettings s;
  s.angle_resolution = angle_resolution;
  s.angle_noise = angle_noise;
  s.speed_noise = 0.3;
  s.torque_walk = 74.0;
  s.speed_walk = 0.3;
  s.inertia_walk = 5e-4;
  s.initial_torque_std = 300.0;
  s.initial_inertia_std = 0.3;
  s.max_speed = 300.0;
  return s;
}

}  // namespace hammer_loads::test
