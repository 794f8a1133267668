/// Constants that tests of several rooms write their cases with.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads::test {

constexpr StampNs kMs = 1'000'000;               ///< a millisecond, as a length of stamps [ns]
constexpr double kGravity = 9.80665;             ///< [m/s2]
constexpr double kEncoderCount = kTwoPi / 4096;  ///< [rad]
constexpr double kDegreesPerRadian = 180.0 / kPi;

/// Joints as the shipped files name them.
inline const std::vector<std::string> kCrank{"hammer_crank_joint"};
inline const std::vector<std::string> kFour{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};

}  // namespace hammer_loads::test
