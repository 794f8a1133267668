/// Accelerations that a turning hull adds to the links: Coriolis, centrifugal and Euler acceleration (model.md 3).
///
/// A mass at r from D that moves at r' relative to the hull gets r (i alpha - Omega^2) + 2 i Omega r' beside the
/// acceleration of D, which is part of the effective gravity. The loads are linear in it: everything here is added.
#pragma once

#include "hammer_loads/linkage/hull_motion.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// To be multiplied by directions as LinkAccelerations are; a link that turns at w gets i alpha - Omega (Omega + 2 w).
struct TurningAccelerations {
  LinkAccelerations links;
  Planar hull;  ///< of points fixed to the hull [1/s2]
};

inline TurningAccelerations turningAccelerations(const LinkMotion& l, double speed, const HullMotion& hull) noexcept {
  const auto of = [&](double link_rate) {
    return Planar{-hull.rate * (hull.rate + 2.0 * link_rate), hull.acceleration};
  };
  return {{of(speed), of(l.v * speed), of(l.rocker.u * speed)}, of(0.0)};
}

/// Of all moving links about D, as functions of the crank angle.
struct MomentsAboutD {
  double inertia{};           ///< J_D [kg m2]
  double half_slope{};        ///< half of dJ_D/dphi [kg m2/rad]
  double half_slope_slope{};  ///< its derivative
  double momentum{};          ///< angular momentum relative to the hull over crank speed [kg m2]
  double momentum_slope{};    ///< its derivative by the crank angle
};

/// Level rocker: J_D = I.
inline MomentsAboutD momentsAboutDRocker(const Mechanism& mechanism, const Motion& m) noexcept {
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  return {inertia, 0.0, 0.0, inertia * m.u, inertia * m.du};
}

/// Level linkage. A stands at -pivot.
inline MomentsAboutD momentsAboutDLinkage(const Mechanism& mechanism, const LinkMotion& l) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta, coupling = linkCoupling(mechanism, l);
  const Planar from_d = conj(k.pivot) * (crank + rod);
  const Planar by_angle = conj(k.pivot) * (crank + l.v * rod);
  const Planar by_angle_slope = conj(k.pivot) * (turned(crank + l.v * l.v * rod) + l.dv * rod);
  const double inertia_a = (p.crank_mass + p.rod_mass) * (k.pivot.re * k.pivot.re + k.pivot.im * k.pivot.im);
  const double u = l.rocker.u, swing = l.v - 1.0;  // of the rod in the crank
  return {
      inertia_a - 2.0 * from_d.re + k.crank_inertia + k.rod_inertia + 2.0 * coupling.re + p.rocker_inertia_about_pivot,
      by_angle.im - swing * coupling.im, by_angle_slope.im - l.dv * coupling.im - swing * swing * coupling.re,
      k.crank_inertia + k.rod_inertia * l.v + p.rocker_inertia_about_pivot * u + (1.0 + l.v) * coupling.re -
          by_angle.re,
      k.rod_inertia * l.dv + p.rocker_inertia_about_pivot * l.rocker.du + l.dv * coupling.re -
          (1.0 + l.v) * swing * coupling.im - by_angle_slope.re};
}

}  // namespace hammer_loads
