#include "hammer_loads/boom/gravity.h"

#include <cmath>

#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

Eigen::Vector3d gravityInRoot(double gravity, const BaseTilt& base) noexcept {
  return gravity * Eigen::Vector3d(std::sin(base.pitch), -std::cos(base.pitch) * std::sin(base.roll),
                                   -std::cos(base.pitch) * std::cos(base.roll));
}

Eigen::Vector3d gravityInTip(const Chain& chain, const JointVector& position, const Eigen::Vector3d& g_B) noexcept {
  ChainPose pose;
  forwardKinematics(chain, position, pose);
  return pose.tip().linear().transpose() * g_B;
}

}  // namespace hammer_loads
