/// Hull wrench and pin forces of level linkage together, under one gravity, in fewer operations than one after the
/// other: for many states at once.
///
/// The same equations as hullWrenchLinkage and pinForcesLinkage (their headers say what is neglected). Weights are
/// taken off each link's inertia force at once, so the moments of crank about A, rod about B and rocker about D serve
/// the hull's moment, the drive torque and the force in C.
#pragma once

#include "hammer_loads/hammer/link_loads.h"

namespace hammer_loads {

/// The parts that do not change with the state. Hull axes: a constant C seen from the hull (LinkMoments) times e^(i
/// angle) has x + i z = (-Re C + i Im C) e^(-i angle).
struct LinkageConstants {
  LinkageConstants(const Mechanism& mechanism, Gravity g) {
    const LinkMoments& m = mechanism.moments();
    const HammerParameters& p = mechanism.parameters();
    less_crank = {m.crank.re, -m.crank.im};
    less_rod = {m.rod.re, -m.rod.im};
    less_rod_at_b = {m.rod_at_b.re, -m.rod_at_b.im};
    rocker = {-m.rocker, 0.0};
    along_rod = {-mechanism.cosComAngle(), -mechanism.sinComAngle()};
    const double crank_rod_mass = m.mass - p.rocker_mass;
    crank_rod_weight = {crank_rod_mass * g.x, crank_rod_mass * g.z};
    rod_weight = {p.rod_mass * g.x, p.rod_mass * g.z};
    rocker_weight = {p.rocker_mass * g.x, p.rocker_mass * g.z};
    crank_weight_moment = {m.crank.im * g.x + m.crank.re * g.z, m.crank.re * g.x - m.crank.im * g.z};
    rod_weight_moment = {m.rod.im * g.x + m.rod.re * g.z, m.rod.re * g.x - m.rod.im * g.z};
    rocker_weight_moment = {m.rocker * g.z, m.rocker * g.x};
    coupling = m.coupling;
    pivot = m.pivot;
    crank_inertia = m.crank_inertia, rod_inertia = m.rod_inertia, rocker_inertia = p.rocker_inertia_about_pivot;
    less_rod_force_factor = -m.rod_force_factor, less_inv_rod_length = -m.inv_rod_length;
    rocker_over_rod = m.rocker_over_rod, crank_length = p.lengths.crank;
  }

  Planar less_crank, less_rod, less_rod_at_b, rocker, along_rod;  ///< hull axes; `less` with reversed sign [kg m]
  Planar crank_rod_weight, rod_weight, rocker_weight;             ///< hull axes [N]
  /// Scalar product with the link's direction: moment of its weight (crank: with the rod's mass at B) [N m].
  Planar crank_weight_moment, rod_weight_moment, rocker_weight_moment;
  Planar coupling, pivot;                             ///< as in LinkMoments
  double crank_inertia, rod_inertia, rocker_inertia;  ///< about A, B, D [kg m2]
  double less_rod_force_factor, less_inv_rod_length, rocker_over_rod, crank_length;
};

namespace detail {

/// Constant of LinkageConstants times a direction (or what it is multiplied with), in hull axes.
constexpr Planar onHull(Planar constant, Planar a) noexcept {
  return {constant.re * a.re + constant.im * a.im, constant.im * a.re - constant.re * a.im};
}
constexpr double product(Planar a, Planar b) noexcept { return a.re * b.re + a.im * b.im; }
constexpr PinForce pinForce(Planar hull) noexcept { return {hull.re, hull.im}; }

}  // namespace detail

/// l with s > 0 (kNoSine where it is below kLeastSine) wherever pin forces are wanted; they are not flagged near the
/// blow.
HAMMER_LOADS_INLINE LinkLoads linkageLoads(const LinkageConstants& k, const LinkMotion& l, double speed,
                                           double acceleration) noexcept {
  const LinkAccelerations q = linkAccelerations(l, speed, acceleration);
  // Inertia force and weight, of crank and rod with reversed sign.
  const Planar at_phi = l.phi * q.crank;
  const Planar less_crank = detail::onHull(k.less_crank, at_phi) + k.crank_rod_weight;
  const Planar less_rod = detail::onHull(k.less_rod, l.beta * q.rod);
  const Planar less_crank_rod = less_crank + less_rod;
  const Planar rocker = detail::onHull(k.rocker, l.psi * q.rocker) - k.rocker_weight;

  // Rates of angular momentum less moments of weight: crank about A (rod's mass at B), rod about B, rocker about D.
  const Planar coupling = k.coupling * l.delta;
  const double about_a = k.crank_inertia * acceleration + coupling.re * q.rod.im + coupling.im * q.rod.re -
                         detail::product(k.crank_weight_moment, l.phi);
  const double about_b = k.rod_inertia * q.rod.im + coupling.re * acceleration - coupling.im * q.crank.re -
                         detail::product(k.rod_weight_moment, l.beta);
  const double about_d = k.rocker_inertia * q.rocker.im - detail::product(k.rocker_weight_moment, l.psi);

  LinkLoads loads;
  const Planar hull = less_crank_rod - rocker;
  loads.wrench = {hull.re, hull.im,
                  -k.pivot.re * less_crank_rod.im - k.pivot.im * less_crank_rod.re - about_a - about_b - about_d};

  // R23 = (along + i across) e^(i beta).
  const double across = k.less_inv_rod_length * about_b;
  const double along_s =
      (about_d + k.rocker_over_rod * l.cos_mu * about_b) * (k.less_rod_force_factor * l.rocker.inv_r);
  const double along = detail::overSine(along_s, l.rocker.sin_half);
  const Planar rod_axis = detail::onHull(k.along_rod, l.beta);
  const Planar on_rocker = detail::onHull(rod_axis, {along, across});
  const Planar less_rod_at_b = detail::onHull(k.less_rod_at_b, at_phi) + k.rod_weight;
  loads.pins.rod_on_rocker = detail::pinForce(on_rocker);
  loads.pins.hull_on_rocker = detail::pinForce(rocker - on_rocker);
  loads.pins.hull_on_crank = detail::pinForce(on_rocker - less_crank_rod);
  loads.pins.crank_on_rod = detail::pinForce(on_rocker - less_rod - less_rod_at_b);
  loads.pins.drive_torque = about_a + k.crank_length * (along_s * l.sin_delta_over_s + across * l.delta.re);
  return loads;
}

}  // namespace hammer_loads
