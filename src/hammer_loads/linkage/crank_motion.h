/// Speed and acceleration of the crank.
#pragma once

#include "hammer_loads/linkage/crank_angle.h"

namespace hammer_loads {

struct CrankMotion {
  CrankAngle angle;
  double speed{};         ///< w [rad/s], positive counter-clockwise in (xi, eta)
  double acceleration{};  ///< e [rad/s2]
};

}  // namespace hammer_loads
