#pragma once

#include <limits>

namespace hammer_loads {

constexpr double kTwoPi = 6.283185307179586232;  ///< 2.4e-16 less than 2 pi
constexpr double kPi = 0.5 * kTwoPi;
constexpr double kDegree = kPi / 180.0;       ///< [rad]
constexpr double kStandardGravity = 9.80665;  ///< [m/s2]
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace hammer_loads
