/// What moving masses demand of the joints: KDL's recursions with their arrays made once.
#pragma once

#include <memory>

#include "hammer_loads/boom/chain.h"

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
  /// Positive drives the joint forward, as in jointTorqueOfTipLoad(). Recursive Newton-Euler; nothing is computed at
  /// rest.
  JointVector torqueOfMotion(const JointMotion& motion) noexcept;

  /// Mass matrix M(q) [kg m2], symmetric, positive definite. Composite rigid bodies.
  JointMatrix massMatrix(const JointVector& position) noexcept;

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace hammer_loads
