/// What the mechanism's moving links are to the crank's shaft: a variable inertia and a weight torque.
#pragma once

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/motion.h"

namespace hammer_loads {

/// Kinetic energy of the links = inertia/2 w^2 for crank speed w; motor and flywheel are not included.
struct ShaftLoad {
  double inertia{};              ///< reflected inertia of the links [kg m2]
  double half_inertia_slope{};   ///< half its derivative by the crank angle [kg m2/rad]
  double weight_torque{};        ///< torque of the links' weight on the crank [N m]
  double weight_torque_slope{};  ///< its derivative by the crank angle [N m/rad]
};

/// Level rocker: I u^2 and the rocker's weight. Neglects mass and inertia of crank and rod (a constant part of them acts
/// like drive inertia).
inline ShaftLoad shaftLoadRocker(const Mechanism& mechanism, const Motion& m, Gravity gravity) noexcept {
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  const double ux = inertia * m.u;
  // Rocker weight times distance: moment about D and its derivative by psi.
  const double moment = mechanism.rockerFirstMoment() * (m.sin_psi * gravity.x + m.cos_psi * gravity.z);
  const double moment_slope = mechanism.rockerFirstMoment() * (m.cos_psi * gravity.x - m.sin_psi * gravity.z);
  return {ux * m.u, ux * m.du, m.u * moment, m.du * moment + m.u * m.u * moment_slope};
}

}  // namespace hammer_loads
