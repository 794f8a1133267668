/// Ranges of a boom's parameters. No machine exceeds them, and no product of values within them overflows.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace figure {

constexpr double kLeastLength = 1e-6, kMostLength = 1e3;  ///< [m]
constexpr double kMostMass = 1e9;                         ///< [kg]; also of an identified link's inertia [kg m2]
// Limit: kLeastLength, kMostLength, kMostMass

}  // namespace figure

/// Adds a line to problems if the value is not within its range.
inline void checkRange(const std::string& key, double value, const std::string& unit, double least, double most,
                       std::vector<std::string>& problems) {
  if (value >= least && value <= most) return;
  const std::string behind = unit.empty() ? unit : " " + unit;
  problems.push_back(
      format("%s: %.9g%s, must be from %g to %g%s", key.c_str(), value, behind.c_str(), least, most, behind.c_str()));
}

}  // namespace hammer_loads
