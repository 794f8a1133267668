/// Ranges of the numbers of a boom: beyond them no figure lies, and no product of figures overflows.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace figure {

constexpr double kLeastLength = 1e-6, kMostLength = 1e3;  ///< [m]
constexpr double kMostMass = 1e9;                         ///< [kg]; of a weighed link's inertia [kg m2] as well
// Limit: kLeastLength, kMostLength, kMostMass

}  // namespace figure

/// Adds a line for a number that is not within its range.
inline void checkRange(const std::string& key, double value, const std::string& unit, double least, double most,
                       std::vector<std::string>& problems) {
  if (value >= least && value <= most) return;
  const std::string behind = unit.empty() ? unit : " " + unit;
  problems.push_back(
      format("%s: %.9g%s, must be from %g to %g%s", key.c_str(), value, behind.c_str(), least, most, behind.c_str()));
}

}  // namespace hammer_loads
