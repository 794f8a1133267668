/// Newton-Euler recursion of the links of a chain, and the torques of moving masses on the joints.
#pragma once

#include <array>
#include <memory>
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

/// Mass and inertia of each link, including the bodies that are fixed to it beside the chain. The root has none, since
/// its load goes into the ground.
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

/// Rigid links, no friction. After construction no allocation.
class ChainDynamics {
 public:
  explicit ChainDynamics(const Chain& chain);
  ~ChainDynamics();
  ChainDynamics(const ChainDynamics& other);
  ChainDynamics& operator=(const ChainDynamics& other);
  ChainDynamics(ChainDynamics&&) noexcept;
  ChainDynamics& operator=(ChainDynamics&&) noexcept;

  /// Torque on the joints from the links' inertia as the boom moves: -(M q'' + c(q, q')) [N m], without weight.
  /// Positive drives the joint forward, as in jointTorqueOfTipLoad(). pose: of motion.position. Recursive Newton-Euler;
  /// nothing is computed at rest.
  JointVector torqueOfMotion(const ChainPose& pose, const PlacedBodies& bodies,
                             const JointMotion& motion) const noexcept;

  /// Finds the loads by inertia and weight of the links; g_B: gravity in the root's axes [m/s2].
  void chainLoads(const ChainPose& pose, const PlacedBodies& bodies, const JointMotion& motion,
                  const Eigen::Vector3d& g_B, ChainLoads& result) const noexcept;

  /// The links' bodies at a pose: what the loads of any motion there need.
  void place(const ChainPose& pose, PlacedBodies& bodies) const noexcept;

  /// Mass matrix M(q) [kg m2], symmetric, positive definite. KDL's composite rigid bodies, its arrays made once.
  JointMatrix massMatrix(const JointVector& position) noexcept;

  /// The weight's part of a stiffness about a pose, minus the derivative of jointTorqueOfWeight(): symmetric
  /// [N m/rad].
  JointMatrix weightStiffness(const JointVector& position, const Eigen::Vector3d& g_B) const noexcept;

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace hammer_loads
