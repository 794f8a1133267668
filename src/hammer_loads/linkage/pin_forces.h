/// Forces in the pins of the mechanism and the drive torque, dyad by dyad in closed form.
///
/// Forces in hammer_hull axes: R01 BY hull ON crank at A, R12 BY crank ON rod at B, R23 BY rod ON rocker at C,
/// R03 BY hull ON rocker at D. No matrix is solved: the rocker's moment about D and the rod's about B give R23.
///
/// At the blow rod and rocker are in line. R23 along the rod has the divisor sin mu = s (sin mu/s), s = sin(phi/2). The
/// terms with w^2 u', w^2 v' and sin(beta - phi) contain s too and are divided without it: exact at and near the blow.
/// The rest (crank acceleration, weight, rod centre of mass off its line) grows as 1/s: a rigid in-line rod cannot turn
/// the rocker. It is returned unchanged and flagged near_blow while s is significant. Within the rounding or the error
/// of the crank angle (NearBlow) the forces are NaN, unless the rest vanishes to the last digit: then they have their
/// finite limit. The drive torque always has one.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

struct PinForce {
  double x{};  ///< [N]
  double z{};  ///< [N]
};

constexpr PinForce operator+(PinForce a, PinForce b) noexcept { return {a.x + b.x, a.z + b.z}; }

struct PinReactions {
  PinForce hull_on_crank;   ///< R01 at A
  PinForce crank_on_rod;    ///< R12 at B
  PinForce rod_on_rocker;   ///< R23 at C
  PinForce hull_on_rocker;  ///< R03 at D
  double drive_torque{};    ///< BY the drive ON the crank about +y [N m]; inertia of motor and flywheel not included
  bool near_blow{};         ///< transmission angle below the limit of NearBlow
};

namespace detail {

/// Smallest s = sin(phi/2) used as a divisor. An angle within a revolution is rounded by half as much, so that a
/// smaller s has an error of its own size.
constexpr double kLeastSine = kTwoPi * std::numeric_limits<double>::epsilon();
/// Substitute for a smaller s: negligible beside any rest, large enough to preserve the finite part.
constexpr double kNoSine = 1e-290;
constexpr double kNoRest = 1e-200;  ///< larger than kNoSine times a finite part, smaller than any rest

/// Returns divided/s; `divided` is proportional to s plus a rest. NaN if s is substituted and a rest remains.
HAMMER_LOADS_INLINE double overSine(double divided, double s) noexcept {
  const bool lost = s == kNoSine && std::abs(divided) > kNoRest;
  return lost ? std::numeric_limits<double>::quiet_NaN() : divided / s;
}

}  // namespace detail

/// Region around the blow in which pin forces are flagged or undefined. They are flagged where the transmission angle
/// psi - beta is below a limit [rad], in (0, pi/2). They are NaN where the crank is closer to the blow than the error
/// of its angle [rad].
class NearBlow {
 public:
  explicit NearBlow(double transmission_angle) : sine_(std::sin(transmission_angle)) {}
  /// Returns the same region for another error of the angle [rad].
  NearBlow withAngleError(double angle_error) const noexcept {
    NearBlow other = *this;
    other.least_ = std::max(detail::kLeastSine, 0.5 * angle_error);
    return other;
  }
  bool operator()(const LinkMotion& l) const noexcept { return l.sin_mu < sine_ && l.cos_mu > 0.0; }
  /// Returns s as a divisor, or its substitute.
  double sine(double s) const noexcept { return s < least_ ? detail::kNoSine : s; }

 private:
  double sine_, least_{detail::kLeastSine};
};

/// Transmission angle psi - beta [rad], in [0, pi]; 0 at the blow only.
inline double transmissionAngle(const LinkMotion& l) noexcept { return std::atan2(l.sin_mu, l.cos_mu); }

namespace detail {

/// Converts from the frame turned by a (LinkMoments) to hull axes.
constexpr PinForce toHull(Planar f) noexcept { return {-f.re, f.im}; }

}  // namespace detail

/// Level rocker: P0 (6)-(14) with the signs corrected; crank and rod massless, so R01 = R12 = R23 along the rod.
/// Deviates: P0 (6), (7), (8), (11), (12), see model.md 7. Neglects what hullWrenchRocker neglects.
HAMMER_LOADS_INLINE PinReactions pinForcesRocker(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& c,
                                                 Gravity gravity, const NearBlow& near_blow) noexcept {
  const Motion& m = l.rocker;
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  const double ww = c.speed * c.speed;
  const double mass = mechanism.parameters().rocker_mass;
  const Planar rocker = mechanism.rockerFirstMoment() * l.psi;
  const double weight = rocker.im * gravity.x + rocker.re * gravity.z;
  const double psi_accel = m.du_over_s * (m.sin_half * ww) + m.u * c.acceleration;

  // Rod force along B->C times s, positive when the rod pushes the rocker away from B.
  const double with_s = inertia * m.du_over_s * ww, rest = inertia * m.u * c.acceleration - weight;
  const double s = near_blow.sine(m.sin_half);
  const double along = detail::overSine(-(with_s * s + rest) * (mechanism.moments().rod_force_factor * m.inv_r), s);
  const Planar rod = along * (l.beta * Planar{mechanism.cosComAngle(), -mechanism.sinComAngle()});
  PinReactions pins;
  pins.rod_on_rocker = detail::toHull(rod);
  pins.crank_on_rod = pins.rod_on_rocker;
  pins.hull_on_crank = pins.rod_on_rocker;
  pins.hull_on_rocker = detail::toHull(rocker * Planar{-m.u * m.u * ww, psi_accel} - rod);
  pins.hull_on_rocker.x -= mass * gravity.x;
  pins.hull_on_rocker.z -= mass * gravity.z;
  pins.drive_torque = m.u * (inertia * psi_accel - weight);
  pins.near_blow = near_blow(l);
  return pins;
}

namespace detail {

/// Returns the pin forces for a given force in C, (along + i across) e^(i beta). of_crank: moment about A by which that
/// force acts on the crank [N m].
HAMMER_LOADS_INLINE PinReactions fromRodForce(const Mechanism& mechanism, const LinkMotion& l,
                                              const LinkAccelerations& q, Gravity gravity, Planar rod_force,
                                              double of_crank) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta, coupling = k.coupling * l.delta;
  const Planar weight{-gravity.x, gravity.z};  // per mass
  const Planar on_rocker = rod_force * (l.beta * Planar{mechanism.cosComAngle(), -mechanism.sinComAngle()});
  const Planar above_crank = on_rocker + rod * q.rod;
  const Planar on_rod = above_crank + (k.rod_at_b * l.phi) * q.crank - p.rod_mass * weight;
  const Planar on_crank = above_crank + crank * q.crank - (k.mass - p.rocker_mass) * weight;
  PinReactions pins;
  pins.rod_on_rocker = toHull(on_rocker);
  pins.crank_on_rod = toHull(on_rod);
  pins.hull_on_crank = toHull(on_crank);
  pins.hull_on_rocker = toHull(k.rocker * (l.psi * q.rocker) - p.rocker_mass * weight - on_rocker);
  // Crank about A, the rod's mass at B counted with it.
  pins.drive_torque = k.crank_inertia * q.crank.im - (crank.im * gravity.x + crank.re * gravity.z) +
                      coupling.re * q.rod.im + coupling.im * q.rod.re + of_crank;
  return pins;
}

}  // namespace detail

/// Level linkage: mass, centre of mass, inertia and weight of all three links. Neglects friction, inertia of motor and
/// flywheel.
HAMMER_LOADS_INLINE PinReactions pinForcesLinkage(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& c,
                                                  Gravity gravity, const NearBlow& near_blow) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const Motion& m = l.rocker;
  const double ww = c.speed * c.speed, e = c.acceleration;
  const Planar rod = k.rod * l.beta, coupling = k.coupling * l.delta;

  // Rocker about D: l3 cross(e^(i psi), R23) = s rocker_s + rocker_rest.
  const double inertia = p.rocker_inertia_about_pivot;
  const double rocker_s = inertia * m.du_over_s * ww;
  const double rocker_rest = inertia * m.u * e - k.rocker * (l.psi.re * gravity.z + l.psi.im * gravity.x);
  // Rod about B: -l2 cross(e^(i beta), R23) = s rod_s + rod_rest.
  const double rod_s = (k.rod_inertia * l.dv_over_s + k.coupling.re * l.sin_delta_over_s) * ww;
  const double rod_rest = (k.rod_inertia * l.v + coupling.re) * e + k.coupling.im * l.delta.re * ww -
                          (rod.im * gravity.x + rod.re * gravity.z);
  // R23 = (along + i across) e^(i beta); along has the divisor sin mu.
  const double s = near_blow.sine(m.sin_half);
  const double across = -(s * rod_s + rod_rest) * k.inv_rod_length;
  const double rod_part = k.rocker_over_rod * l.cos_mu;
  const double along_s =
      -((rocker_s + rod_part * rod_s) * s + (rocker_rest + rod_part * rod_rest)) * (k.rod_force_factor * m.inv_r);
  const double along = detail::overSine(along_s, s);

  const double of_crank = p.lengths.crank * (along_s * l.sin_delta_over_s + across * l.delta.re);
  PinReactions pins = detail::fromRodForce(mechanism, l, linkAccelerations(l, c.speed, c.acceleration), gravity,
                                           {along, across}, of_crank);
  pins.near_blow = near_blow(l);
  return pins;
}

/// Pin forces of the same dyads for links that do not move as with a rigid rod: psi and accelerations are given. Near
/// the blow the rod's force is the difference of large moments and as accurate as these; NaN within the error of the
/// angle.
inline PinReactions pinForcesOf(const Mechanism& mechanism, const LinkMotion& l, const LinkAccelerations& q,
                                Gravity gravity, const NearBlow& near_blow) noexcept {
  const LinkLengths& lengths = mechanism.linkage().lengths();
  const LinkMoments& k = mechanism.moments();
  const Planar rod = k.rod * l.beta, coupling = k.coupling * l.delta, mu = l.psi * conj(l.beta);
  const double rocker_moment = mechanism.parameters().rocker_inertia_about_pivot * q.rocker.im -
                               k.rocker * (l.psi.re * gravity.z + l.psi.im * gravity.x);
  const double rod_moment = k.rod_inertia * q.rod.im + coupling.re * q.crank.im - coupling.im * q.crank.re -
                            (rod.im * gravity.x + rod.re * gravity.z);
  const double across = -rod_moment / lengths.rod;
  const bool has_none = near_blow.sine(l.rocker.sin_half) == detail::kNoSine;
  const double along =
      has_none ? std::numeric_limits<double>::quiet_NaN() : (across * mu.re - rocker_moment / lengths.rocker) / mu.im;
  PinReactions pins = detail::fromRodForce(mechanism, l, q, gravity, {along, across},
                                           lengths.crank * (along * l.delta.im + across * l.delta.re));
  pins.near_blow = near_blow(l);
  return pins;
}

/// Adds the part of a turning hull at level rocker.
inline void addTurningRocker(const Mechanism& mechanism, const LinkMotion& l, double speed, const HullMotion& hull,
                             const NearBlow& near_blow, PinReactions& pins) noexcept {
  const Planar q = turningAccelerations(l, speed, hull).links.rocker;
  const double moment = mechanism.parameters().rocker_inertia_about_pivot * hull.acceleration;
  const double along = detail::overSine(-moment * (mechanism.moments().rod_force_factor * l.rocker.inv_r),
                                        near_blow.sine(l.rocker.sin_half));
  const Planar rod = along * (l.beta * Planar{mechanism.cosComAngle(), -mechanism.sinComAngle()});
  for (PinForce* force : {&pins.rod_on_rocker, &pins.crank_on_rod, &pins.hull_on_crank}) {
    *force = *force + detail::toHull(rod);
  }
  pins.hull_on_rocker = pins.hull_on_rocker + detail::toHull(mechanism.rockerFirstMoment() * (l.psi * q) - rod);
  pins.drive_torque += l.rocker.u * moment;
}

/// Adds the part of a turning hull at level linkage: the dyads of pinForcesLinkage with the added accelerations.
inline void addTurningLinkage(const Mechanism& mechanism, const LinkMotion& l, double speed, const HullMotion& hull,
                              const NearBlow& near_blow, PinReactions& pins) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const TurningAccelerations t = turningAccelerations(l, speed, hull);
  const LinkAccelerations& q = t.links;
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta, coupling = linkCoupling(mechanism, l);
  const Planar at_a = -1.0 * (k.pivot * t.hull);  // acceleration of pin A

  // Moments of the inertia forces: rocker about D, rod about B, crank about A with the rod's mass at B.
  const double rocker_moment = p.rocker_inertia_about_pivot * hull.acceleration;
  const double rod_moment = k.rod_inertia * hull.acceleration + (conj(rod) * at_a).im + (conj(coupling) * q.crank).im;
  const double crank_moment = k.crank_inertia * hull.acceleration + (conj(crank) * at_a).im + (coupling * q.rod).im;

  const double across = -rod_moment * k.inv_rod_length;
  const double along_s =
      -(rocker_moment + k.rocker_over_rod * l.cos_mu * rod_moment) * (k.rod_force_factor * l.rocker.inv_r);
  const double along = detail::overSine(along_s, near_blow.sine(l.rocker.sin_half));
  const Planar on_rocker = Planar{along, across} * (l.beta * Planar{mechanism.cosComAngle(), -mechanism.sinComAngle()});
  const Planar above_crank = on_rocker + rod * q.rod;
  const Planar on_rod = above_crank + (k.rod_at_b * l.phi) * q.crank + p.rod_mass * at_a;
  const Planar on_crank = above_crank + crank * q.crank + k.fixed * t.hull;
  pins.rod_on_rocker = pins.rod_on_rocker + detail::toHull(on_rocker);
  pins.crank_on_rod = pins.crank_on_rod + detail::toHull(on_rod);
  pins.hull_on_crank = pins.hull_on_crank + detail::toHull(on_crank);
  pins.hull_on_rocker = pins.hull_on_rocker + detail::toHull(k.rocker * (l.psi * q.rocker) - on_rocker);
  pins.drive_torque += crank_moment + p.lengths.crank * (along_s * l.sin_delta_over_s + across * l.delta.re);
}

/// Pin forces at a level of the model (level pulse: as rocker) of a motion already known.
HAMMER_LOADS_INLINE PinReactions pinForces(const Mechanism& mechanism, Level level, const LinkMotion& l,
                                           const CrankMotion& crank, const HullMotion& hull,
                                           const NearBlow& near_blow) noexcept {
  if (level != Level::kLinkage) {
    PinReactions pins = pinForcesRocker(mechanism, l, crank, hull.gravity, near_blow);
    if (hull.turns()) addTurningRocker(mechanism, l, crank.speed, hull, near_blow, pins);
    return pins;
  }
  PinReactions pins = pinForcesLinkage(mechanism, l, crank, hull.gravity, near_blow);
  if (hull.turns()) addTurningLinkage(mechanism, l, crank.speed, hull, near_blow, pins);
  return pins;
}

/// Pin forces from the crank's motion. No allocation, no failure for finite input.
HAMMER_LOADS_INLINE PinReactions pinForces(const Mechanism& mechanism, Level level, const CrankMotion& crank,
                                           const HullMotion& hull, const NearBlow& near_blow) noexcept {
  return pinForces(mechanism, level, linkMotion(mechanism.linkage(), crank.angle), crank, hull, near_blow);
}

}  // namespace hammer_loads
