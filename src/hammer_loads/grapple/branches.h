/// Every pose of the lever group for one place of pin A, in closed form up to a polynomial of degree 6.
#pragma once

#include <array>

#include "hammer_loads/grapple/lever_group.h"

namespace hammer_loads {

/// All real poses (assembly modes): no more than six.
struct Branches {
  struct Branch {
    double theta2{};       ///< direction of AB, in [-pi, pi] [rad]
    double theta5{};       ///< direction of OD, in [-pi, pi] [rad]
    double determinant{};  ///< det J [m4]; its sign distinguishes the two branches that meet in a fold
  };
  std::array<Branch, 6> branch;
  int count{};
  /// The group can move with A held (a parallelogram with |AO| = bd = ce): there is no finite list.
  bool self_motion{};
};

/// Enumerates with |OA| fixed: seen from link 2 the pin O satisfies two linear equations for each angle
/// alpha = theta5 - theta2, and its distance from A leaves a trigonometric polynomial of degree 3 in alpha, solved as a
/// real polynomial of degree 6 in tan(alpha/2) with companion eigenvalues; Newton then removes their rounding. a =
/// place of pin A in the grapple frame [m]. No allocation. Poses closer to a fold than some 1e-8 rad may be missed or
/// doubled.
Branches enumerateBranches(const LeverGroup& group, Planar a) noexcept;

}  // namespace hammer_loads
