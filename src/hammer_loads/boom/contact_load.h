/// The rock's force on the hull from joint torques that no other load explains.
#pragma once

#include <optional>

#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

/// Load on the tip, forces along its x and z and moment about its y, that makes these torques on three joints of the
/// chain: what a cylinder's measured force holds (-force times arm) less hammer, weight, motion and vibration. About
/// the tip's origin, axes of the tip; force across the plane zero. Nothing where the three joints do not move the tip
/// in its plane independently (boom and arm in line). Errors grow as 1/sine of the angle between boom and arm.
std::optional<Wrench> inPlaneTipLoad(const ChainPose& pose, const std::array<int, 3>& joints,
                                     const Eigen::Vector3d& torque) noexcept;

}  // namespace hammer_loads
