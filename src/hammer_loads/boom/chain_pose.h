/// Poses of the chain's links at given joint positions, and wrenches transformed between them.
#pragma once

#include <array>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/wrench.h"

namespace hammer_loads {

/// Frames of the links and axes of the joints in the root's frame B.
struct ChainPose {
  int links{}, joints{};
  std::array<Pose, kMaxLinks> X_BL;                ///< pose of each link, index as in Chain
  std::array<Eigen::Vector3d, kMaxJoints> axis_B;  ///< unit vector of each joint
  std::array<Eigen::Vector3d, kMaxJoints> p_BJ_B;  ///< a point on each joint's axis [m]
  std::array<bool, kMaxJoints> prismatic{};
  std::array<double, kMaxJoints> sine{}, cosine{};  ///< sine and cosine of each revolute joint's position

  const Pose& tip() const noexcept { return X_BL[static_cast<std::size_t>(links - 1)]; }
  const Pose& link(int index) const noexcept { return X_BL[static_cast<std::size_t>(index)]; }
};

/// Finds all poses. position: one entry per joint, finite. Does not allocate or fail; error some 1e-15 of the lengths.
void forwardKinematics(const Chain& chain, const JointVector& position, ChainPose& pose) noexcept;

/// Returns velocity of the tip's origin and angular velocity of the tip per joint rate, in the axes of the tip.
Jacobian tipJacobian(const ChainPose& pose) noexcept;

/// Returns the wrench shifted to the origin of a link of the chain, in the axes of that link.
Wrench wrenchAtLink(const ChainPose& pose, int link, const Wrench& w_tip) noexcept;

/// Returns the joint torques of the links' weight. g_B: gravity in the root's axes [m/s2].
JointVector jointTorqueOfWeight(const Chain& chain, const ChainPose& pose, const Eigen::Vector3d& g_B) noexcept;

/// Mass and its centre in the root's frame.
struct PointMass {
  double mass{};                                ///< [kg]
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
};

/// Returns all links from `first` to the tip as one point mass in the root's frame.
PointMass massFrom(const Chain& chain, const ChainPose& pose, int first) noexcept;

}  // namespace hammer_loads
