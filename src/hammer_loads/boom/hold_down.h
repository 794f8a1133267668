/// Hold-down capacity of the machine, and the rock's force on the hull from torques that no other load explains.
#pragma once

#include <array>

#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {

/// Supports of the machine in the root's frame, all on the ground.
struct Supports {
  double front_x{};           ///< stabilisers, on the boom's side [m], > rear_x
  double front_half_width{};  ///< [m], > 0
  double rear_x{};            ///< far wheels or blade [m]
  double rear_half_width{};   ///< [m], > 0
};

/// Factors by which a mean load may be multiplied before a support or a cylinder yields. Infinity: the load relieves
/// it, or the machine's supports are not known. 0: it yields already.
struct HoldDown {
  double machine{};  ///< factor at which the machine tips over an edge of its supports or lifts
  int edge{};        ///< edge of machine: 0 front, 1 left, 2 rear, 3 right
  std::array<double, kMaxJoints>
      cylinder{};  ///< factor at which a relief valve opens, per cylinder; 0 at a zero moment arm
  double least{};  ///< smallest of all factors
};

/// Load on the tip (force x and z, moment y) from the torques that it causes on three joints of the chain. Such a
/// torque is -force times arm of a measured cylinder force, less hammer, weight, motion and vibration. The load is
/// about the tip's origin in the axes of the tip, with zero force across the plane. Errors grow as 1/sine of the angle
/// between boom and arm.
class InPlaneTip {
 public:
  /// J of tipJacobian().
  InPlaneTip(const Jacobian& J, const std::array<int, 3>& joints) noexcept;
  /// Returns false where the three joints do not move the tip independently in its plane (boom and arm in line).
  bool isKnown() const noexcept { return known_; }
  /// Returns the load in the plane, linear in the torques on all joints [N m]: force x, z [N], moment y [N m].
  template <typename Torques>
  Eigen::Vector3d inPlane(const Torques& torque) const noexcept {
    return inverse_ * Eigen::Vector3d(torque[joints_[0]], torque[joints_[1]], torque[joints_[2]]);
  }
  template <typename Torques>
  Wrench load(const Torques& torque) const noexcept {
    const Eigen::Vector3d load = inPlane(torque);
    return {{load[0], 0.0, load[1]}, {0.0, load[2], 0.0}};
  }

 private:
  std::array<int, 3> joints_;
  bool known_;
  Eigen::Matrix3d inverse_;  ///< (force x, force z, moment y) per torque on the joints
};

}  // namespace hammer_loads
