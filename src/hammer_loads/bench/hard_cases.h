/// States on which the cost table judges every way to the loads.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/linkage/hull_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::accuracy {

/// Angles of one machine under one speed, acceleration and gravity.
struct HardCase {
  std::string name;
  HammerParameters hammer;     ///< as given, the rod not corrected
  double speed{};              ///< [rad/s]
  double acceleration{};       ///< [rad/s2]
  Gravity gravity;             ///< [m/s2]
  std::vector<double> angles;  ///< in (0, 2 pi) [rad]; meant is exactly the number stored
};

/// The first is the regular turn, four are offsets of 1, 2.7 and 6.1 times 1e-1 to 1e-12 rad before and after the blow,
/// the others have both, coarser. P0's 31.416 rad/s and a hull pitched by 0.3 rad where nothing else is said.
std::vector<HardCase> hardCases(const HammerParameters& hammer);

/// Angles of a whole turn, evenly spaced, none at the blow.
std::vector<double> turnAngles(std::size_t count);

}  // namespace hammer_loads::accuracy
