/// Newton-Euler recursion of the links of a chain: motion of each link, and the load of its inertia on its joint.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/section.h"

namespace hammer_loads {

/// Motion of a link in the root's axes.
struct BodyMotion {
  Eigen::Vector3d rate;                  ///< [rad/s]
  Eigen::Vector3d angular_acceleration;  ///< [rad/s2]
  Eigen::Vector3d acceleration;          ///< acceleration of the link's origin [m/s2]
};

/// A body where its link stands, in the root's axes.
struct PlacedBody {
  double mass;              ///< [kg]
  Eigen::Vector3d com;      ///< centre of mass from the link's origin [m]
  Eigen::Matrix3d inertia;  ///< about the centre of mass [kg m2]
};
using PlacedBodies = std::array<PlacedBody, kMaxLinks>;  ///< index of links as in Chain

/// Index of links as in Chain. The root has no entry, since its load goes into the ground.
struct ChainLoads {
  std::array<BodyMotion, kMaxLinks> motion;  ///< accelerations less gravity
  std::array<Wrench, kMaxLinks> beyond;      ///< by inertia and weight of a link and all beyond it, in the root's frame
};

/// Mass and inertia of each link with what is fixed to it beside the chain; the root has none: its own load goes into
/// the ground.
std::vector<RigidBody> bodiesOf(const Chain& chain);

/// Bodies of bodiesOf() at a pose.
void placeBodies(const std::vector<RigidBody>& bodies, const ChainPose& pose, PlacedBodies& placed) noexcept;

/// bodies: at the pose; g_B: gravity in the root's axes [m/s2]. No allocation.
void findChainLoads(const Chain& chain, const PlacedBodies& bodies, const ChainPose& pose, const JointMotion& motion,
                    const Eigen::Vector3d& g_B, ChainLoads& result) noexcept;

/// Joint torques by inertia and weight; positive drives the joint forward [N m] ([N] for a prismatic one).
JointVector jointTorque(const Chain& chain, const ChainPose& pose, const ChainLoads& loads) noexcept;

/// Load of a body's inertia, in the root's frame.
Wrench bodyLoad(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion) noexcept;

inline Wrench operator+(const Wrench& a, const Wrench& b) noexcept { return {a.force + b.force, a.torque + b.torque}; }

}  // namespace hammer_loads
