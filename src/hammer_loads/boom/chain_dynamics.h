/// Newton-Euler recursion of the links of a chain, and the torques of moving masses on the joints. Rigid links, no
/// friction; no allocation.
#pragma once

#include <array>
#include <memory>

#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

/// Motion of a link in the root's axes.
struct BodyMotion {
  Eigen::Vector3d rate;                  ///< [rad/s]
  Eigen::Vector3d angular_acceleration;  ///< [rad/s2]
  Eigen::Vector3d acceleration;          ///< acceleration of the link's origin [m/s2]
};

/// Bodies of the links at a pose, in the root's axes, centres of mass from each link's origin; index as in Chain. The
/// root has none, since its load goes into the ground.
using PlacedBodies = std::array<RigidBody, kMaxLinks>;

/// Loads of the links, index as in Chain. The root has no entry, since its load goes into the ground.
struct ChainLoads {
  std::array<BodyMotion, kMaxLinks> motion;  ///< accelerations minus gravity
  std::array<Wrench, kMaxLinks> beyond;      ///< load of inertia and weight of a link and all beyond it, root's frame
};

void placeBodies(const Chain& chain, const ChainPose& pose, PlacedBodies& placed) noexcept;

/// Finds the loads by inertia and weight of the links. bodies: at the pose, which is that of motion.position; g_B:
/// gravity in the root's axes [m/s2].
void findChainLoads(const Chain& chain, const ChainPose& pose, const PlacedBodies& bodies, const JointMotion& motion,
                    const Eigen::Vector3d& g_B, ChainLoads& result) noexcept;

/// Returns joint torques by inertia and weight [N m] ([N] for a prismatic joint); positive drives the joint forward.
JointVector jointTorque(const Chain& chain, const ChainPose& pose, const ChainLoads& loads) noexcept;

/// Returns the joint torques of the links' inertia, -(M q'' + c(q, q')) [N m], without weight. Positive drives the
/// joint forward, as in Boom::hammerTorque(). Uses recursive Newton-Euler; at rest it computes nothing.
JointVector torqueOfMotion(const Chain& chain, const ChainPose& pose, const PlacedBodies& bodies,
                           const JointMotion& motion) noexcept;

/// Returns the load of a body's inertia, in the root's frame.
Wrench bodyLoad(const RigidBody& body, const Pose& X_BL, const BodyMotion& motion) noexcept;

/// Returns the stiffness by weight about a pose, minus the derivative of jointTorqueOfWeight(); symmetric [N m/rad].
JointMatrix weightStiffness(const Chain& chain, const JointVector& position, const Eigen::Vector3d& g_B) noexcept;

/// Mass matrix of a chain by KDL's composite-rigid-body algorithm, with arrays that are allocated once.
class MassMatrix {
 public:
  explicit MassMatrix(const Chain& chain);
  ~MassMatrix();
  MassMatrix(const MassMatrix& other);
  MassMatrix& operator=(const MassMatrix& other);
  MassMatrix(MassMatrix&&) noexcept;
  MassMatrix& operator=(MassMatrix&&) noexcept;

  const Chain& chain() const noexcept;
  /// M(q) [kg m2], symmetric, positive definite.
  JointMatrix at(const JointVector& position) noexcept;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace hammer_loads
