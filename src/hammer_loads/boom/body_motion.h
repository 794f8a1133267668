/// Newton and Euler for the links of a chain: how each moves, and the load of its inertia on what holds it.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/section.h"

namespace hammer_loads {

/// How a link moves in the root's axes.
struct BodyMotion {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                  ///< [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< [rad/s2]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< of its origin [m/s2]

  Eigen::Vector3d accelerationAt(const Eigen::Vector3d& r) const noexcept {
    return acceleration + angular_acceleration.cross(r) + rate.cross(rate.cross(r));
  }
};

/// Of each link, index as in Chain.
using BodyMotions = std::array<BodyMotion, kMaxLinks>;

/// root_acceleration: of the chain's root [m/s2]; against gravity it stands for the weight. No allocation.
void findMotions(const Chain& chain, const ChainPose& pose, const JointMotion& motion,
                 const Eigen::Vector3d& root_acceleration, BodyMotions& result) noexcept;

/// Mass and inertia of each link with what is fixed to it beside the chain; the root has none: its own load goes into
/// the ground.
std::vector<RigidBody> bodiesOf(const Chain& chain);

/// Of a body's inertia, in the root's frame.
Wrench bodyLoad(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion) noexcept;

inline Wrench operator+(const Wrench& a, const Wrench& b) noexcept { return {a.force + b.force, a.torque + b.torque}; }

}  // namespace hammer_loads
