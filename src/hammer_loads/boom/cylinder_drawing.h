/// Joint positions with which a robot description displays a cylinder and its linkage.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/cylinder.h"

namespace hammer_loads {

/// Geometry of one cylinder whose joint turns about y. The barrel turns about its pin on the link before, and the rod
/// slides in it. The guide link turns about its pivot on the link before, the coupler about its pin on the link beyond.
/// Angles are positive about +y. At zero each body lies along x of its carrying link, and the cylinder is closed.
class CylinderDrawing {
 public:
  static constexpr std::size_t kMost = 4;

  CylinderDrawing(const Chain& chain, const Cylinder& cylinder);

  /// Returns NAME_barrel_joint and NAME_rod_joint, and with a linkage NAME_guide_joint and NAME_coupler_joint. Empty
  /// where the joint does not turn about y.
  const std::vector<std::string>& names() const noexcept { return names_; }
  /// Returns the positions in the order of the names [rad], [m]. joint_angle: of the cylinder's joint [rad].
  std::array<double, kMost> positions(double joint_angle) const noexcept;

 private:
  Cylinder cylinder_;
  std::vector<std::string> names_;
  Eigen::Vector2d base_, guide_{0.0, 0.0}, rod_;  ///< from the joint, at zero, axes of the link before [m]
  double sense_;
};

}  // namespace hammer_loads
