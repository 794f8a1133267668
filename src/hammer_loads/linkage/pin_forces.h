/// Forces in the pins of the mechanism and the drive torque, dyad by dyad in closed form.
///
/// Forces in hammer_hull axes: R01 BY hull ON crank at A, R12 BY crank ON rod at B, R23 BY rod ON rocker at C,
/// R03 BY hull ON rocker at D. No matrix is solved: the rocker's moment about D and the rod's about B give R23.
///
/// At the blow rod and rocker are in line. R23 along the rod has the divisor sin mu = s (sin mu/s), s = sin(phi/2). The
/// terms with w^2 u', w^2 v' and sin(beta - phi) contain s too and are divided without it: exact at and near the blow.
/// The rest (crank acceleration, weight, rod centre of mass off its line) grows as 1/s: a rigid in-line rod cannot turn
/// the rocker. It is returned as it is, flagged near_blow; at the blow itself it is some 1e290, never NaN.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"

namespace hammer_loads {

struct PinForce {
  double x{};  ///< [N]
  double z{};  ///< [N]
};

struct PinReactions {
  PinForce hull_on_crank;    ///< R01 at A
  PinForce crank_on_rod;     ///< R12 at B
  PinForce rod_on_rocker;    ///< R23 at C
  PinForce hull_on_rocker;   ///< R03 at D
  double drive_torque{};     ///< BY the drive ON the crank about +y [N m]; inertia of motor and flywheel not included
  bool near_blow{};          ///< transmission angle below the limit of NearBlow
};

/// Transmission angle psi - beta below which pin forces are flagged [rad], in (0, pi/2).
class NearBlow {
 public:
  explicit NearBlow(double transmission_angle) : sine_(std::sin(transmission_angle)) {}
  bool operator()(const LinkMotion& l) const noexcept { return l.sin_mu < sine_ && l.cos_mu > 0.0; }

 private:
  double sine_;
};

/// Transmission angle psi - beta [rad], in [0, pi]; 0 at the blow only.
inline double transmissionAngle(const LinkMotion& l) noexcept { return std::atan2(l.sin_mu, l.cos_mu); }

namespace detail {

/// (with_s s + rest)/sin mu, where s is cancelled; at s = 0 the rest is divided by 1e-290 instead.
inline double dividedBySinMu(const LinkMotion& l, double with_s, double rest) noexcept {
  constexpr double kTiny = 1e-290;
  const double s = std::abs(l.rocker.sin_half) < kTiny ? kTiny : l.rocker.sin_half;
  return (with_s * s + rest) / (l.sin_mu_over_s * s);
}

/// From the frame turned by a (LinkMoments) to hull axes.
constexpr PinForce toHull(Planar f) noexcept { return {-f.re, f.im}; }

}  // namespace detail

/// Level rocker: P0 (6)-(14) with the signs mended; crank and rod massless, so R01 = R12 = R23 along the rod.
/// Deviates: P0 (6), (7), (8), (11), (12), see model.md 7. Neglects what hullWrenchRocker neglects.
inline PinReactions pinForcesRocker(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& crank,
                                 Gravity gravity, const NearBlow& near_blow) noexcept {
  const Motion& m = l.rocker;
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  const double ww = crank.speed * crank.speed;
  const double mass = mechanism.parameters().rocker_mass;
  const double first_moment = mechanism.rockerFirstMoment();
  const double weight = first_moment * (m.sin_psi * gravity.x + m.cos_psi * gravity.z);
  const double psi_accel = m.du * ww + m.u * crank.acceleration;

  // Rod force along B->C, positive when the rod pushes the rocker away from B.
  const double along = -detail::dividedBySinMu(l, inertia * m.du_over_s * ww, inertia * m.u * crank.acceleration - weight) /
                       mechanism.parameters().lengths.rocker;
  const Planar rod = along * (l.beta * Planar{mechanism.cosComAngle(), -mechanism.sinComAngle()});
  const Planar rocker = first_moment * (l.psi * Planar{-m.u * m.u * ww, psi_accel});
  PinReactions pins;
  pins.rod_on_rocker = detail::toHull(rod);
  pins.crank_on_rod = pins.rod_on_rocker;
  pins.hull_on_crank = pins.rod_on_rocker;
  pins.hull_on_rocker = detail::toHull(rocker - rod);
  pins.hull_on_rocker.x -= mass * gravity.x;
  pins.hull_on_rocker.z -= mass * gravity.z;
  pins.drive_torque = m.u * (inertia * psi_accel - weight);
  pins.near_blow = near_blow(l);
  return pins;
}

/// Level linkage: mass, centre of mass, inertia and weight of all three links. Neglects friction, motion of the hull,
/// inertia of motor and flywheel.
inline PinReactions pinForcesLinkage(const Mechanism& mechanism, const LinkMotion& l, const CrankMotion& crank,
                                  Gravity gravity, const NearBlow& near_blow) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const LinkAccelerations q = linkAccelerations(l, crank.speed, crank.acceleration);
  const Motion& m = l.rocker;
  const double ww = crank.speed * crank.speed, e = crank.acceleration;
  const Planar rod = k.rod * l.beta;

  // Rocker about D: l3 cross(e^(i psi), R23) = s rocker_s + rocker_rest.
  const double rocker_s = p.rocker_inertia_about_pivot * m.du_over_s * ww;
  const double rocker_rest = p.rocker_inertia_about_pivot * m.u * e -
                             k.rocker * (m.sin_psi * gravity.x + m.cos_psi * gravity.z);
  // Rod about B: -l2 cross(e^(i beta), R23) = s rod_s + rod_rest.
  const double rod_s = (k.rod_inertia * l.dv_over_s + k.coupling.re * l.sin_delta_over_s) * ww;
  const double rod_rest = k.rod_inertia * l.v * e + linkCoupling(mechanism, l).re * e +
                          k.coupling.im * l.delta.re * ww - (rod.re * gravity.z + rod.im * gravity.x);
  const double l3_over_l2 = p.lengths.rocker / p.lengths.rod;
  const double across = -(m.sin_half * rod_s + rod_rest) / p.lengths.rod;
  const double along = -detail::dividedBySinMu(l, rocker_s + l3_over_l2 * l.cos_mu * rod_s,
                                               rocker_rest + l3_over_l2 * l.cos_mu * rod_rest) / p.lengths.rocker;

  const Planar to_hull{mechanism.cosComAngle(), -mechanism.sinComAngle()};
  const Planar weight_per_mass{-gravity.x, gravity.z};
  const Planar on_rocker = Planar{along, across} * (l.beta * to_hull);
  const Planar b_turned = (p.lengths.crank * p.rod_mass * to_hull) * q.crank_turned;  // rod mass times B's acceleration
  const Planar on_rod = on_rocker + b_turned + k.rod * q.rod_turned - p.rod_mass * weight_per_mass;
  const Planar on_crank = on_rod + k.crank_alone * q.crank_turned - p.crank_mass * weight_per_mass;
  PinReactions pins;
  pins.rod_on_rocker = detail::toHull(on_rocker);
  pins.crank_on_rod = detail::toHull(on_rod);
  pins.hull_on_crank = detail::toHull(on_crank);
  pins.hull_on_rocker = detail::toHull(k.rocker * q.rocker_turned - p.rocker_mass * weight_per_mass - on_rocker);
  pins.drive_torque = driveTorque(shaftLoadLinkage(mechanism, l, gravity), crank.speed, e);
  pins.near_blow = near_blow(l);
  return pins;
}

/// Pin forces at a level of the model (level pulse: as rocker). No allocation, no failure for finite input.
inline PinReactions pinForces(const Mechanism& mechanism, Level level, const CrankMotion& crank, Gravity gravity,
                           const NearBlow& near_blow) noexcept {
  const LinkMotion l = linkMotion(mechanism.linkage(), crank.angle);
  return level == Level::kLinkage ? pinForcesLinkage(mechanism, l, crank, gravity, near_blow)
                                  : pinForcesRocker(mechanism, l, crank, gravity, near_blow);
}

}  // namespace hammer_loads
