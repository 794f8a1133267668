#include "hammer_loads/boom/cylinder_drawing.h"

#include <cmath>

namespace hammer_loads {
namespace {

/// Returns the rotation about +y that takes x to this direction [rad].
double directionOf(const Eigen::Vector2d& v) noexcept { return std::atan2(-v.y(), v.x()); }

}  // namespace

CylinderDrawing::CylinderDrawing(const Chain& chain, const Cylinder& cylinder) : cylinder_(cylinder) {
  const CylinderParameters& p = cylinder.parameters();
  const ChainLink& link = chain.link(chain.linkBeyond(cylinder.joint()));
  const Eigen::Vector2d origin(link.origin.x(), link.origin.z());
  const Eigen::Vector3d rod = (link.steady + link.cosine) * Eigen::Vector3d(p.rod_x, 0.0, p.rod_z);
  base_ = Eigen::Vector2d(p.base_x, p.base_z) - origin;
  if (p.linkage) guide_ = Eigen::Vector2d(p.linkage->guide_x, p.linkage->guide_z) - origin;
  rod_ = {rod.x(), rod.z()};
  sense_ = link.axis.y() > 0.0 ? 1.0 : -1.0;
  if (std::abs(link.axis.y()) < 1.0 - 1e-6) return;
  names_ = {p.name + "_barrel_joint", p.name + "_rod_joint"};
  if (p.linkage) names_.insert(names_.end(), {p.name + "_guide_joint", p.name + "_coupler_joint"});
}

std::array<double, CylinderDrawing::kMost> CylinderDrawing::positions(double joint_angle) const noexcept {
  const CylinderPosition at = cylinder_.at(joint_angle);
  const double turn = sense_ * joint_angle, c = std::cos(turn), s = std::sin(turn);
  const Eigen::Vector2d direct(rod_.x() * c + rod_.y() * s, rod_.y() * c - rod_.x() * s);
  const Eigen::Vector2d pin = cylinder_.linkage() ? at.rod_pin : direct;
  return {directionOf(pin - base_), at.length - cylinder_.parameters().closed_length, directionOf(pin - guide_),
          directionOf(pin - direct) - turn};
}

}  // namespace hammer_loads
