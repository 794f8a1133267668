/// How much of the mechanism a computation takes into account.
#pragma once

namespace hammer_loads {

/// Each level equals the next richer one in the limit of vanishing crank and rod masses.
enum class Level {
  kRocker,   ///< P0: crank and rod massless; rocker mass, inertia and weight
  kLinkage,  ///< crank and rod with mass, centre of mass and inertia as well
};

/// Gravity in hull axes [m/s2]: (g sin pitch, 0, -g cos pitch) for a level base.
struct Gravity {
  double x{};
  double z{};
};

}  // namespace hammer_loads
