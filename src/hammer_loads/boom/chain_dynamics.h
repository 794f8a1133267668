/// Torques of moving masses on the joints.
#pragma once

#include <memory>

#include "hammer_loads/boom/body_motion.h"

namespace hammer_loads {

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
