/// Load of the mechanism's moving links on the hull, which may move itself (model.md 3).
#pragma once

#include <Eigen/Core>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/two_bodies.h"

namespace hammer_loads {

/// BY the moving links ON the hull, moment about D, axes of hammer_hull (model.md 1).
struct HullWrench {
  double force_x{};   ///< [N]
  double force_z{};   ///< [N], positive lifts the hull off the rock
  double torque_y{};  ///< about +y [N m]
};

inline HullWrench operator+(const HullWrench& a, const HullWrench& b) noexcept {
  return {a.force_x + b.force_x, a.force_z + b.force_z, a.torque_y + b.torque_y};
}
inline HullWrench operator*(double factor, const HullWrench& a) noexcept {
  return {factor * a.force_x, factor * a.force_z, factor * a.torque_y};
}

inline Eigen::Vector3d vectorOf(const HullWrench& w) noexcept { return {w.force_x, w.force_z, w.torque_y}; }
inline HullWrench wrenchOf(const Eigen::Vector3d& w) noexcept { return {w[0], w[1], w[2]}; }

/// Momentum of the moving links relative to the hull, axes of hammer_hull, angular momentum about D.
/// The impulse of the wrench without weight over any interval between blows is minus its change (model.md 3); in a
/// hull that moves, that of the wrench without frameWrench, in the hull's axes.
struct LinkMomentum {
  double x{};        ///< [N s]
  double z{};        ///< [N s]
  double about_d{};  ///< about +y [N m s]
};

/// Weight of the moving links as a wrench on the hull. Level rocker: the rocker's alone.
HAMMER_LOADS_INLINE HullWrench weightWrenchRocker(const Mechanism& mechanism, const Motion& m,
                                                  Gravity gravity) noexcept {
  const double mass = mechanism.parameters().rocker_mass;
  return {mass * gravity.x, mass * gravity.z,
          mechanism.rockerFirstMoment() * (m.sin_psi * gravity.x + m.cos_psi * gravity.z)};
}

/// Level linkage: that of all links.
HAMMER_LOADS_INLINE HullWrench weightWrenchLinkage(const Mechanism& mechanism, const LinkMotion& l,
                                                   Gravity gravity) noexcept {
  const LinkMoments& k = mechanism.moments();
  const Planar first_moment = k.fixed + k.crank * l.phi + k.rod * l.beta + k.rocker * l.psi;
  return {k.mass * gravity.x, k.mass * gravity.z, first_moment.re * gravity.z + first_moment.im * gravity.x};
}

/// Level rocker: mass and inertia of the rocker, crank and rod massless (P0). Neglects: inertia and weight of crank and
/// rod, friction. Momentum theorem: no pin force is formed, so nothing is singular at the blow.
/// Deviates: P0 (1) prints P_tau and M with the sign of the acceleration; inertia opposes it (model.md 7).
HAMMER_LOADS_INLINE HullWrench hullWrenchRocker(const Mechanism& mechanism, const Motion& m, const CrankMotion& crank,
                                                Gravity gravity) noexcept {
  const double psi_rate = m.u * crank.speed;
  const double psi_accel = m.du_over_s * (m.sin_half * crank.speed * crank.speed) + m.u * crank.acceleration;
  const double normal = psi_rate * psi_rate;
  const double first_moment = mechanism.rockerFirstMoment();
  HullWrench wrench = weightWrenchRocker(mechanism, m, gravity);
  wrench.force_x -= first_moment * (normal * m.cos_psi + psi_accel * m.sin_psi);
  wrench.force_z += first_moment * (normal * m.sin_psi - psi_accel * m.cos_psi);
  wrench.torque_y -= mechanism.parameters().rocker_inertia_about_pivot * psi_accel;
  return wrench;
}

HAMMER_LOADS_INLINE LinkMomentum linkMomentumRocker(const Mechanism& mechanism, const Motion& m,
                                                    double speed) noexcept {
  const double psi_rate = m.u * speed;
  const double size = mechanism.rockerFirstMoment() * psi_rate;
  return {size * m.sin_psi, size * m.cos_psi, mechanism.parameters().rocker_inertia_about_pivot * psi_rate};
}

/// Level linkage: mass, centre of mass, inertia and weight of crank, rod and rocker. Neglects: friction, inertia of
/// motor and flywheel. Momentum theorem in the frame turned by a, where hull x = -re and z = im:
/// sum m a = C1 e^(i phi)(i e - w^2) + C2 e^(i beta)(...) + C3 e^(i psi)(...); see LinkMoments.
HAMMER_LOADS_INLINE HullWrench hullWrenchOf(const Mechanism& mechanism, const LinkMotion& l, const LinkAccelerations& q,
                                            Gravity gravity) noexcept {
  const LinkMoments& k = mechanism.moments();
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta;
  const Planar crank_rod = crank * q.crank + rod * q.rod;
  const Planar all = crank_rod + k.rocker * (l.psi * q.rocker);
  const Planar first_moment = k.fixed + crank + rod + k.rocker * l.psi;
  const Planar coupling = linkCoupling(mechanism, l);
  // d/dt of the angular momentum about D; A stands at -pivot.
  const double momentum_rate = k.crank_inertia * q.crank.im + k.rod_inertia * q.rod.im +
                               mechanism.parameters().rocker_inertia_about_pivot * q.rocker.im -
                               (k.pivot.re * crank_rod.im - k.pivot.im * crank_rod.re) +
                               coupling.re * (q.rod.im + q.crank.im) + coupling.im * (q.rod.re - q.crank.re);
  return {k.mass * gravity.x + all.re, k.mass * gravity.z - all.im,
          first_moment.re * gravity.z + first_moment.im * gravity.x - momentum_rate};
}

HAMMER_LOADS_INLINE HullWrench hullWrenchLinkage(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& c,
                                                 Gravity gravity) noexcept {
  return hullWrenchOf(mechanism, l, linkAccelerations(l, c.speed, c.acceleration), gravity);
}

HAMMER_LOADS_INLINE LinkMomentum linkMomentumLinkage(const Mechanism& mechanism, const LinkMotion& l,
                                                     double speed) noexcept {
  const LinkMoments& k = mechanism.moments();
  const double rod_rate = l.v * speed, rocker_rate = l.rocker.u * speed;
  const Planar crank_rod = speed * (k.crank * l.phi) + rod_rate * (k.rod * l.beta);
  const Planar all = turned(crank_rod + (rocker_rate * k.rocker) * l.psi);
  const double coupling = linkCoupling(mechanism, l).re;
  const double about_d = k.crank_inertia * speed + k.rod_inertia * rod_rate +
                         mechanism.parameters().rocker_inertia_about_pivot * rocker_rate +
                         coupling * (speed + rod_rate) - (k.pivot.re * crank_rod.re + k.pivot.im * crank_rod.im);
  return {-all.re, all.im, about_d};
}

/// Mass of the links that a level gives weight and momentum [kg].
inline double movingMass(const Mechanism& mechanism, Level level) noexcept {
  return level == Level::kLinkage ? mechanism.moments().mass : mechanism.parameters().rocker_mass;
}

/// Adds the wrench of the masses' accelerations by the hull's turning: `inertia_forces` their sum, seen from the hull.
inline void addTurning(const MomentsAboutD& moments, Planar inertia_forces, double speed, const HullMotion& hull,
                       HullWrench& wrench) noexcept {
  wrench.force_x += inertia_forces.re;
  wrench.force_z -= inertia_forces.im;
  wrench.torque_y -= moments.inertia * hull.acceleration + 2.0 * hull.rate * speed * moments.half_slope;
}

inline void addTurningRocker(const Mechanism& mechanism, const Motion& m, double speed, const HullMotion& hull,
                             HullWrench& wrench) noexcept {
  const Planar q{-hull.rate * (hull.rate + 2.0 * m.u * speed), hull.acceleration};
  const Planar forces = mechanism.rockerFirstMoment() * (Planar{m.cos_psi, m.sin_psi} * q);
  addTurning(momentsAboutDRocker(mechanism, m), forces, speed, hull, wrench);
}

inline void addTurningLinkage(const Mechanism& mechanism, const LinkMotion& l, double speed, const HullMotion& hull,
                              HullWrench& wrench) noexcept {
  const LinkMoments& k = mechanism.moments();
  const TurningAccelerations t = turningAccelerations(l, speed, hull);
  const Planar forces = k.fixed * t.hull + (k.crank * l.phi) * t.links.crank + (k.rod * l.beta) * t.links.rod +
                        k.rocker * (l.psi * t.links.rocker);
  addTurning(momentsAboutDLinkage(mechanism, l), forces, speed, hull, wrench);
}

/// Level rocker in a hull that moves. For a hull that does not turn the result equals that of hullWrenchRocker to the
/// bit.
HAMMER_LOADS_INLINE HullWrench hullWrench(const Mechanism& mechanism, const Motion& m, const CrankMotion& crank,
                                          const HullMotion& hull) noexcept {
  HullWrench wrench = hullWrenchRocker(mechanism, m, crank, hull.gravity);
  if (hull.turns()) addTurningRocker(mechanism, m, crank.speed, hull, wrench);
  return wrench;
}

/// Level linkage, as above.
HAMMER_LOADS_INLINE HullWrench hullWrench(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& crank,
                                          const HullMotion& hull) noexcept {
  HullWrench wrench = hullWrenchLinkage(mechanism, l, crank, hull.gravity);
  if (hull.turns()) addTurningLinkage(mechanism, l, crank.speed, hull, wrench);
  return wrench;
}

/// Hull wrench at a level of the model (level pulse: as rocker; the half-sine itself is in hull_model.h).
/// No allocation, no failure for finite input.
HAMMER_LOADS_INLINE HullWrench hullWrench(const Mechanism& mechanism, Level level, const CrankMotion& crank,
                                          const HullMotion& hull) noexcept {
  const Motion m = motion(mechanism.linkage(), crank.angle);
  if (level != Level::kLinkage) return hullWrench(mechanism, m, crank, hull);
  return hullWrench(mechanism, linkMotion(mechanism.linkage().ratios(), m), crank, hull);
}

/// The part of hullWrench that is not the change of linkMomentum: weight and motion of the hull. Smooth in time, so
/// that its impulse can be summed where linkMomentum's difference gives the rest.
inline HullWrench frameWrench(const Mechanism& mechanism, Level level, const LinkMotion& l, double speed,
                              const HullMotion& hull) noexcept {
  if (level != Level::kLinkage) {
    HullWrench wrench = weightWrenchRocker(mechanism, l.rocker, hull.gravity);
    if (hull.turns()) addTurningRocker(mechanism, l.rocker, speed, hull, wrench);
    return wrench;
  }
  HullWrench wrench = weightWrenchLinkage(mechanism, l, hull.gravity);
  if (hull.turns()) addTurningLinkage(mechanism, l, speed, hull, wrench);
  return wrench;
}

inline LinkMomentum linkMomentum(const Mechanism& mechanism, Level level, const LinkMotion& l, double speed) noexcept {
  if (level != Level::kLinkage) return linkMomentumRocker(mechanism, l.rocker, speed);
  return linkMomentumLinkage(mechanism, l, speed);
}

HAMMER_LOADS_INLINE LinkMomentum linkMomentum(const Mechanism& mechanism, Level level, CrankAngle angle,
                                              double speed) noexcept {
  return linkMomentum(mechanism, level, linkMotion(mechanism.linkage(), angle), speed);
}

/// Level elastic, for the motion of the two bodies. links: rigid ones at the crank's angle.
inline HullWrench hullWrenchOf(const Mechanism& mechanism, const TwoBodies& bodies, const TwoBodyState& state,
                               const TwoBodyAccelerations& a, const LinkMotion& links, Gravity gravity) noexcept {
  const LinkMotion turned = withRocker(links, state.displacement);
  return hullWrenchOf(mechanism, turned, bodies.linkAccelerations(state, a, turned), gravity);
}

}  // namespace hammer_loads
