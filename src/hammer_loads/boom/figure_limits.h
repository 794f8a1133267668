/// Beyond these no figure of a boom lies, and no product of figures overflows.
#pragma once

namespace hammer_loads::figure {

constexpr double kMostLength = 1e3;  ///< [m]
constexpr double kMostMass = 1e9;    ///< [kg]; of a weighed link's inertia [kg m2] as well
// Limit: kMostLength, kMostMass

}  // namespace hammer_loads::figure
