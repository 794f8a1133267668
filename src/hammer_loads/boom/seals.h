/// Friction of a cylinder's seals, between its oil and its joint.
#pragma once

#include <cmath>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// Coulomb friction against the rod's motion, as a torque on the joint: the joint's load is that of the oil and
/// way() times this torque. One part of it is known, the other only by its standard deviation.
struct Seals {
  double known{}, deviation{};  ///< standard [N m]
  double driven{};              ///< rate of the joint beside its vibration [rad/s]
  double slow{1.0};             ///< joint rate below which the direction of friction is uncertain [rad/s]

  /// -1 to 1: of the joint, at a rate of vibration [rad/s].
  double way(double vibrating) const noexcept {
    const double rate = driven + vibrating;
    return rate / std::sqrt(square(rate) + square(slow));
  }
};

/// Seals by the boom file. arm [m/rad]; torque of the oil [N m]; driven: rate of the joint without its vibration
/// [rad/s].
inline Seals sealsOf(const Cylinder& cylinder, double arm, double oil_torque, double driven) noexcept {
  // A rod's speed [m/s] near standstill, as Stribeck's.
  constexpr double kSlowRod = 0.002;
  const CylinderParameters& p = cylinder.parameters();
  const double size = std::abs(arm), force = std::abs(oil_torque / arm);
  return {size * (p.friction_force + p.friction * force),
          size * std::sqrt(square(p.friction_force_std) + square(p.friction_std * force)), driven, kSlowRod / size};
}

}  // namespace hammer_loads
