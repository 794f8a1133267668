/// Load of the mechanism's moving links on the hull.
#pragma once

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/motion.h"

namespace hammer_loads {

/// What a wrench needs to know of the crank.
struct CrankMotion {
  CrankAngle angle;
  double speed{};         ///< w [rad/s], positive counter-clockwise in (xi, eta)
  double acceleration{};  ///< e [rad/s2]
};

/// BY the moving links ON the hull, moment about D, axes of hammer_hull (model.md 1).
struct HullWrench {
  double force_x{};   ///< [N]
  double force_z{};   ///< [N], positive lifts the hull off the rock
  double torque_y{};  ///< about +y [N m]
};

/// Momentum of the moving links relative to the hull, axes of hammer_hull, angular momentum about D.
/// The impulse of the wrench without weight over any interval between blows is minus its change (model.md 3).
struct LinkMomentum {
  double x{};        ///< [N s]
  double z{};        ///< [N s]
  double about_d{};  ///< about +y [N m s]
};

/// Weight of the moving links as a wrench on the hull. Level rocker: the rocker's alone.
inline HullWrench weightWrenchRocker(const Mechanism& mechanism, const Motion& m, Gravity gravity) noexcept {
  const double mass = mechanism.parameters().rocker_mass;
  return {mass * gravity.x, mass * gravity.z,
          mechanism.rockerFirstMoment() * (m.sin_psi * gravity.x + m.cos_psi * gravity.z)};
}

/// Level rocker: mass and inertia of the rocker, crank and rod massless (P0). Neglects: inertia and weight of crank and
/// rod, friction, motion of the hull. Momentum theorem: no pin force is formed, so nothing is singular at the blow.
/// Deviates: P0 (1) prints P_tau and M with the sign of the acceleration; inertia opposes it (model.md 7).
inline HullWrench hullWrenchRocker(const Mechanism& mechanism, const Motion& m, const CrankMotion& crank,
                                   Gravity gravity) noexcept {
  const double psi_rate = m.u * crank.speed;
  const double psi_accel = m.du * crank.speed * crank.speed + m.u * crank.acceleration;
  const double normal = psi_rate * psi_rate;
  const double first_moment = mechanism.rockerFirstMoment();
  HullWrench wrench = weightWrenchRocker(mechanism, m, gravity);
  wrench.force_x -= first_moment * (normal * m.cos_psi + psi_accel * m.sin_psi);
  wrench.force_z += first_moment * (normal * m.sin_psi - psi_accel * m.cos_psi);
  wrench.torque_y -= mechanism.parameters().rocker_inertia_about_pivot * psi_accel;
  return wrench;
}

inline LinkMomentum linkMomentumRocker(const Mechanism& mechanism, const Motion& m, double speed) noexcept {
  const double psi_rate = m.u * speed;
  const double size = mechanism.rockerFirstMoment() * psi_rate;
  return {size * m.sin_psi, size * m.cos_psi, mechanism.parameters().rocker_inertia_about_pivot * psi_rate};
}

/// Hull wrench at a level of the model. No allocation, no failure for finite input.
inline HullWrench hullWrench(const Mechanism& mechanism, Level /*level*/, const CrankMotion& crank,
                             Gravity gravity) noexcept {
  return hullWrenchRocker(mechanism, motion(mechanism.linkage(), crank.angle), crank, gravity);
}

inline LinkMomentum linkMomentum(const Mechanism& mechanism, Level /*level*/, CrankAngle angle, double speed) noexcept {
  return linkMomentumRocker(mechanism, motion(mechanism.linkage(), angle), speed);
}

}  // namespace hammer_loads
