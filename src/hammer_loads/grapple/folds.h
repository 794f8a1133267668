/// Ends of a branch of the lever group: folds, the poses with det J = 0.
#pragma once

#include <optional>

#include "hammer_loads/grapple/lever_group.h"

namespace hammer_loads {

/// A pose of the group with rocker 1 in front of it; angles unwrapped along the branch [rad].
struct CurvePoint {
  double theta1{}, theta2{}, theta5{};
};

/// FirstRocker H-O1-A: pin A = o1 + o1a e(theta1) [m].
struct FirstRocker {
  Planar o1;
  double o1a{};
  Planar armAt(double theta1) const noexcept { return o1a * direction(theta1); }  ///< from O1 to A
};

/// End of a search along a branch.
struct BranchEnd {
  enum class Kind {
    kNone,      ///< theta1 moved by the whole span without a fold
    kFold,      ///< det J = 0 at the point
    kSingular,  ///< the curve could not be followed beyond the point: branches cross or the pose moves by itself
  };
  Kind kind{Kind::kNone};
  CurvePoint point;
};

/// Follows the curve of poses by its arc length, which stays regular in a fold, from a pose on it with theta1 growing
/// (sense = +1) or falling (-1) until det J changes sign or theta1 has moved by span [rad]. Angles of the fold to some
/// 1e-15 divided by the curvature there (Newton on both closures and det J).
BranchEnd findBranchEnd(const LeverGroup& group, const FirstRocker& rocker, const CurvePoint& start, int sense,
                        double span);

}  // namespace hammer_loads
