#include "hammer_loads/boom/bucket_linkage.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

/// Returns the derivative of a vector (x, z) by its angle about +y.
Eigen::Vector2d turned(const Eigen::Vector2d& v) noexcept { return {v.y(), -v.x()}; }

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) noexcept { return a.y() * b.x() - a.x() * b.y(); }

}  // namespace

BucketLinkage::BucketLinkage(const Pins& pins, const BucketLinkageParameters& lengths) noexcept
    : pins_(pins), guide_(lengths.guide_length), coupler_(lengths.coupler_length), branch_(lengths.branch) {
  const double squares = guide_ * guide_ + coupler_ * coupler_;
  const double product = 2.0 * guide_ * coupler_ * std::cos(kLeastTransmission);
  least_reach_ = std::sqrt(std::max(0.0, squares - product)), most_reach_ = std::sqrt(squares + product);
}

BucketLinkagePosition BucketLinkage::at(double c, double s) const noexcept {
  BucketLinkagePosition p;
  p.driven_pin = c * pins_.driven + pins_.sense * s * turned(pins_.driven);
  const Eigen::Vector2d between = p.driven_pin - pins_.guide;
  const double square = between.squaredNorm();
  // Foot of the common pin on the line from guide pivot to driven pin, and its height above it, over their distance.
  const double along = 0.5 + 0.5 * (guide_ - coupler_) * (guide_ + coupler_) / square;
  const double height_square = guide_ * guide_ / square - along * along;
  p.closed = height_square > 0.0;
  const double height = p.closed ? std::sqrt(height_square) : 0.0;
  const Eigen::Vector2d guide = along * between + branch_ * height * turned(between);
  p.rod_pin = pins_.guide + guide;
  const Eigen::Vector2d rod = p.rod_pin - pins_.base, coupler = p.rod_pin - p.driven_pin;
  p.length = rod.norm();
  if (!p.closed) return p;
  // The coupler keeps its length: coupler . (velocity of its pin - velocity of the driven pin) = 0.
  const Eigen::Vector2d driven_rate = pins_.sense * turned(p.driven_pin), across = turned(guide);
  const double gear = coupler.dot(across), guide_rate = coupler.dot(driven_rate) / gear;
  const Eigen::Vector2d rate = guide_rate * across, coupler_rate = rate - driven_rate;
  const double guide_change =
      (coupler.dot(guide_rate * guide_rate * guide - p.driven_pin) - coupler_rate.squaredNorm()) / gear;
  p.arm = rod.dot(rate) / p.length;
  p.arm_rate = (rate.squaredNorm() + rod.dot(guide_change * across - guide_rate * guide_rate * guide) - p.arm * p.arm) /
               p.length;
  return p;
}

BucketLinkageForces BucketLinkage::forces(const Eigen::Vector2d& rod_pin,
                                          const Eigen::Vector2d& driven_pin) const noexcept {
  const Eigen::Vector2d guide = rod_pin - pins_.guide, coupler = rod_pin - driven_pin;
  BucketLinkageForces f;
  f.rod = (rod_pin - pins_.base).normalized();
  const double between = cross(guide, coupler);
  f.guide = -cross(f.rod, coupler) / between * guide;
  f.coupler = -cross(guide, f.rod) / between * coupler;
  return f;
}

}  // namespace hammer_loads
