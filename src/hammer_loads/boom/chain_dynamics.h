/// What moving masses demand of the joints: KDL's recursions with their arrays made once.
#pragma once

#include <kdl/chaindynparam.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "hammer_loads/boom/chain.h"

namespace hammer_loads {

/// Rigid links, no friction. After construction no allocation.
class ChainDynamics {
 public:
  explicit ChainDynamics(const Chain& chain);

  /// Torque on the joints from the links' inertia as the boom moves: -(M q'' + c(q, q')) [N m], without weight. Positive
  /// drives the joint forward, as in jointTorqueOfTipLoad(). Recursive Newton-Euler.
  JointVector torqueOfMotion(const JointMotion& motion) noexcept;

  /// Mass matrix M(q) [kg m2], symmetric, positive definite. Composite rigid bodies.
  JointMatrix massMatrix(const JointVector& position) noexcept;

 private:
  Chain chain_;  ///< keeps alive what the solvers refer to
  KDL::ChainIdSolver_RNE newton_euler_;
  KDL::ChainDynParam composite_bodies_;
  KDL::JntArray position_, velocity_, acceleration_, torque_;
  KDL::JntSpaceInertiaMatrix mass_;
  KDL::Wrenches no_wrenches_;
};

}  // namespace hammer_loads
