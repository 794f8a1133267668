#pragma once

namespace hammer_loads {

constexpr double kTwoPi = 6.283185307179586232;  ///< 2.4e-16 less than 2 pi
constexpr double kPi = 0.5 * kTwoPi;
constexpr double kDegree = kPi / 180.0;  ///< [rad]

}  // namespace hammer_loads
