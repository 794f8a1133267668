/// The rock's force on the hull from joint torques that no other load explains.
#pragma once

#include <optional>

#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

/// Loads on the tip, forces along its x and z and moment about its y, by the torques that they make on three joints of
/// the chain: what a cylinder's measured force holds (-force times arm) less hammer, weight, motion and vibration.
/// About the tip's origin, axes of the tip; force across the plane zero. Errors grow as 1/sine of the angle between
/// boom and arm.
class InPlaneTip {
 public:
  /// J of tipJacobian(); nothing where the three joints do not move the tip in its plane independently (boom and arm in
  /// line).
  static std::optional<InPlaneTip> make(const Jacobian& J, const std::array<int, 3>& joints) noexcept;
  /// Of torques on all joints of the chain [N m]; linear in them.
  template <typename Torques>
  Wrench load(const Torques& torque) const noexcept {
    const Eigen::Vector3d load = inverse_ * Eigen::Vector3d(torque[joints_[0]], torque[joints_[1]], torque[joints_[2]]);
    return {{load[0], 0.0, load[1]}, {0.0, load[2], 0.0}};
  }

 private:
  std::array<int, 3> joints_{};
  Eigen::Matrix3d inverse_;  ///< (force x, force z, moment y) by torques on the joints
};

}  // namespace hammer_loads
