/// Quantities per joint of a chain, without heap: sizes vary up to a fixed most.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

constexpr int kMaxJoints = 8;  ///< moving joints of a chain
constexpr int kMaxLinks = 16;  ///< links of a chain, its root included

/// One entry per moving joint, from the root to the tip.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;
/// Rows: linear velocity, angular velocity; one column per joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

/// How the chain moves; revolute joints in [rad], prismatic ones in [m].
struct JointMotion {
  JointVector position;
  JointVector velocity;      ///< [1/s]
  JointVector acceleration;  ///< [1/s2]; zero where it is not known
};

}  // namespace hammer_loads
