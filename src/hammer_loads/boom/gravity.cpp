#include "hammer_loads/boom/gravity.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/util/functions.h"

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

PitchOfChain pitchOf(const Chain& chain, const std::vector<std::string>& asked) {
  ChainPose pose;
  forwardKinematics(chain, JointVector::Zero(chain.joints()), pose);
  const Eigen::Matrix3d R_BT = pose.tip().linear();
  PitchOfChain result;
  const auto sideOf = [&](int joint) {
    const auto j = static_cast<std::size_t>(joint);
    return pose.prismatic[j] ? 0.0 : R_BT.col(1).dot(pose.axis_B[j]);
  };
  const auto add = [&](const std::string& name, double side) {
    result.joints.push_back(name);
    result.signs.push_back(side < 0.0 ? -1 : 1);
  };
  const bool has_all =
      std::all_of(asked.begin(), asked.end(), [&](const std::string& name) { return chain.jointIndex(name); });
  if (has_all)
    for (const std::string& name : asked) add(name, sideOf(*chain.jointIndex(name)));
  for (int j = 0; !has_all && j < chain.joints(); ++j)
    if (2.0 * square(sideOf(j)) > 1.0)  // axis nearer to y than across it
      add(chain.jointNames()[static_cast<std::size_t>(j)], sideOf(j));
  result.offset = std::atan2(-R_BT(2, 0), R_BT(2, 2));
  return result;
}

}  // namespace hammer_loads
