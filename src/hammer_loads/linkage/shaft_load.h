/// The mechanism's moving links as a load of the crank's shaft: a variable inertia and a torque by weight and hull.
#pragma once

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Kinetic energy of the links = inertia/2 w^2 for crank speed w; motor and flywheel are not included.
struct ShaftLoad {
  double inertia{};              ///< reflected inertia of the links [kg m2]
  double half_inertia_slope{};   ///< half its derivative by the crank angle [kg m2/rad]
  double weight_torque{};        ///< torque of the links' weight and of the hull's motion on the crank [N m]
  double weight_torque_slope{};  ///< derivative of the weight's torque by the crank angle [N m/rad]
  double hull_acceleration{};    ///< alpha, which the drive must follow too; in a ShaftModel r alpha [rad/s2]
};

/// Level rocker: I u^2 and the rocker's weight. Neglects mass and inertia of crank and rod (a constant part of them
/// acts like drive inertia).
HAMMER_LOADS_INLINE ShaftLoad shaftLoadRocker(const Mechanism& mechanism, const Motion& m, Gravity gravity) noexcept {
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  const double ux = inertia * m.u;
  // Rocker weight times distance: moment about D and its derivative by psi.
  const double moment = mechanism.rockerFirstMoment() * (m.sin_psi * gravity.x + m.cos_psi * gravity.z);
  const double moment_slope = mechanism.rockerFirstMoment() * (m.cos_psi * gravity.x - m.sin_psi * gravity.z);
  return {ux * m.u, ux * m.du, m.u * moment, m.du * moment + m.u * m.u * moment_slope, 0.0};
}

/// Level linkage: kinetic energy w^2/2 (J1 + J2 v^2 + I u^2 + 2 v Re K), K = linkCoupling, and the weight of all links.
/// Neglects friction.
HAMMER_LOADS_INLINE ShaftLoad shaftLoadLinkage(const Mechanism& mechanism, const LinkMotion& l,
                                               Gravity gravity) noexcept {
  const LinkMoments& k = mechanism.moments();
  const double rocker_inertia = mechanism.parameters().rocker_inertia_about_pivot;
  const Motion& m = l.rocker;
  const Planar coupling = linkCoupling(mechanism, l);
  ShaftLoad load;
  load.inertia = k.crank_inertia + rocker_inertia * m.u * m.u + l.v * (k.rod_inertia * l.v + 2.0 * coupling.re);
  load.half_inertia_slope =
      rocker_inertia * m.u * m.du + l.dv * (k.rod_inertia * l.v + coupling.re) - l.v * (l.v - 1.0) * coupling.im;
  // Weight's power per crank speed: with the first moment's rate i M', M' = C1 e^(i phi) + v C2 e^(i beta) + ...
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta, rocker = k.rocker * l.psi;
  const Planar rate = crank + l.v * rod + m.u * rocker;
  const Planar slope = turned(crank + l.v * l.v * rod + m.u * m.u * rocker) + l.dv * rod + m.du * rocker;
  load.weight_torque = gravity.z * rate.re + gravity.x * rate.im;
  load.weight_torque_slope = gravity.z * slope.re + gravity.x * slope.im;
  return load;
}

/// Adds the part of a turning hull: power of the added inertia forces per crank speed. Coriolis forces have none.
inline void addTurning(const MomentsAboutD& moments, const HullMotion& hull, ShaftLoad& load) noexcept {
  const double square = hull.rate * hull.rate;
  load.weight_torque += square * moments.half_slope - hull.acceleration * moments.momentum;
  load.weight_torque_slope += square * moments.half_slope_slope - hull.acceleration * moments.momentum_slope;
  load.hull_acceleration = hull.acceleration;
}

/// Shaft load at a level of the model (level pulse: as rocker). No allocation, no failure for finite input.
HAMMER_LOADS_INLINE ShaftLoad shaftLoad(const Mechanism& mechanism, Level level, CrankAngle angle,
                                        const HullMotion& hull) noexcept {
  const Motion m = motion(mechanism.linkage(), angle);
  if (level != Level::kLinkage) {
    ShaftLoad load = shaftLoadRocker(mechanism, m, hull.gravity);
    if (hull.turns()) addTurning(momentsAboutDRocker(mechanism, m), hull, load);
    return load;
  }
  const LinkMotion l = linkMotion(mechanism.linkage().ratios(), m);
  ShaftLoad load = shaftLoadLinkage(mechanism, l, hull.gravity);
  if (hull.turns()) addTurning(momentsAboutDLinkage(mechanism, l), hull, load);
  return load;
}

}  // namespace hammer_loads
