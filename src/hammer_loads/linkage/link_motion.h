/// Motion of crank, rod and rocker, and of the hull that carries them.
#pragma once

#include <cmath>

#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/planar.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

struct HullMotion;

/// Gravity in hull axes [m/s2]: (g sin pitch, 0, -g cos pitch) for a level base.
struct Gravity {
  double x{};
  double z{};

  operator HullMotion() const noexcept;  ///< motion of a hull at rest
};

/// Motion of the frame hammer_hull at its origin D, in its plane. An acceleration of D acts on everything in the hull
/// as gravity in the opposite direction. Both are therefore one quantity: the negative reading of an accelerometer at
/// D.
struct HullMotion {
  Gravity gravity;        ///< effective: gravity less the acceleration of D, hull axes [m/s2]
  double rate{};          ///< Omega, turning rate about +y [rad/s]
  double acceleration{};  ///< angular acceleration about +y [rad/s2]

  bool turns() const noexcept { return rate != 0.0 || acceleration != 0.0; }
  friend bool operator==(const HullMotion& a, const HullMotion& b) noexcept {
    return a.gravity.x == b.gravity.x && a.gravity.z == b.gravity.z && a.rate == b.rate &&
           a.acceleration == b.acceleration;
  }
};

/// Interpolates linearly from a (part 0) to b (part 1); equal motions are returned to the last bit.
inline HullMotion blend(const HullMotion& a, const HullMotion& b, double part) noexcept {
  return {{a.gravity.x + part * (b.gravity.x - a.gravity.x), a.gravity.z + part * (b.gravity.z - a.gravity.z)},
          a.rate + part * (b.rate - a.rate),
          a.acceleration + part * (b.acceleration - a.acceleration)};
}

inline Gravity::operator HullMotion() const noexcept { return {*this, 0.0, 0.0}; }

/// Angles are counter-clockwise in the mechanism frame (model.md 1): psi = rocker from A->D, beta = rod,
/// mu = psi - beta the transmission angle. Rates are per radian of crank angle phi.
struct Motion {
  double sin_psi{}, cos_psi{};
  double u{};               ///< dpsi/dphi [-], P0 (4)
  double du{};              ///< d2psi/dphi2 [1/rad], P0 (5)
  double sin_half{};        ///< s = sin(phi/2) >= 0 within the revolution
  double cos_half{};        ///< c = cos(phi/2), negative before the blow
  double r{};               ///< sqrt(lambda2 lambda3/lambda0 - s^2)
  double inv_r{};           ///< 1/r
  double sin_psi_over_s{};  ///< sin psi/s, finite at the blow
  double du_over_s{};       ///< u'/s, finite at the blow
};

namespace detail {

/// Terms of both sides of the blow, from s >= 0 and c >= 0, sine and cosine of half the offset's size.
struct HalfAngleTerms {
  double s, c, ss, cc;
  double r;  ///< sqrt(g + c^2) = sqrt(r0^2 - s^2), without the difference
  double inv_r;
  double z, g_over_z;   ///< r + c, r - c
  double d, d_squared;  ///< lambda0 r + lambda3 c
};

HAMMER_LOADS_INLINE HalfAngleTerms halfAngleTerms(const CrankRocker::Ratios& k, SineCosine half) noexcept {
  HalfAngleTerms t;
  t.s = half.sine;
  t.c = half.cosine;
  t.ss = t.s * t.s;
  t.cc = t.c * t.c;
  const double rr = k.g + t.cc;
  t.r = std::sqrt(rr);
  t.inv_r = 1.0 / t.r;
  t.z = t.r + t.c;
  t.g_over_z = k.g / t.z;
  t.d = k.lambda0 * t.r + k.lambda3 * t.c;
  t.d_squared = k.lambda0_squared * rr + k.lambda3_squared * t.cc + (2.0 * k.lambda03 * t.c) * t.r;
  return t;
}

/// tan(psi/2) = sigma s/d.
HAMMER_LOADS_INLINE Motion motionAfterBlow(const CrankRocker::Ratios& k, const HalfAngleTerms& t) noexcept {
  const double pp = k.sigma_squared * t.ss;
  const double inv_n = 1.0 / (pp + t.d_squared);
  const double inv_nr = inv_n * t.inv_r;
  const double a = t.r + k.lambda2 * t.c;
  const double bracket = (k.lambda03 * a * t.g_over_z) * inv_nr - (0.5 * k.lambda2 * t.z) * (t.inv_r * t.inv_r);
  Motion m;
  m.sin_psi_over_s = (2.0 * k.sigma * t.d) * inv_n;
  m.cos_psi = (t.d_squared - pp) * inv_n;
  m.u = (k.lambda3_sigma * a) * inv_nr;
  m.du_over_s = (k.lambda3_sigma * t.g_over_z) * inv_nr * bracket;
  m.cos_half = t.c;
  return m;
}

/// tan(psi/2) = s d/q; differences of nearly equal terms are replaced by products with their sums.
HAMMER_LOADS_INLINE Motion motionBeforeBlow(const CrankRocker::Ratios& k, const HalfAngleTerms& t) noexcept {
  const double q = k.k_cos * t.cc + k.k_sin * t.ss;
  const double pp = t.ss * t.d_squared, qq = q * q;
  const double inv_n = 1.0 / (pp + qq);
  const double inv_nr = inv_n * t.inv_r;
  const double a = ((k.lambda2 - 1.0) * t.ss - k.w0) / (t.r + k.lambda2 * t.c) * t.d_squared;
  const double bracket =
      (k.lambda03 * a * t.z) * inv_nr - (0.5 * k.lambda2 * k.sigma * t.g_over_z) * (t.inv_r * t.inv_r);
  Motion m;
  m.sin_psi_over_s = (2.0 * t.d * q) * inv_n;
  m.cos_psi = (qq - pp) * inv_n;
  m.u = (k.lambda3 * a) * inv_nr;
  m.du_over_s = (k.lambda3_over_sigma_squared * t.z * t.d_squared) * inv_nr * bracket;
  m.cos_half = -t.c;
  return m;
}

}  // namespace detail

/// Motion at a crank angle. No allocation, no failure for any finite offset.
HAMMER_LOADS_INLINE Motion motion(const CrankRocker& linkage, CrankAngle angle) noexcept {
  const bool before = angle.side == Side::kBeforeBlow;
  const SineCosine half = sineCosine(before ? -0.5 * angle.offset : 0.5 * angle.offset);
  const detail::HalfAngleTerms t = detail::halfAngleTerms(linkage.ratios(), half);
  Motion m = before ? detail::motionBeforeBlow(linkage.ratios(), t) : detail::motionAfterBlow(linkage.ratios(), t);
  m.sin_half = t.s;
  m.r = t.r;
  m.inv_r = t.inv_r;
  m.sin_psi = t.s * m.sin_psi_over_s;
  m.du = t.s * m.du_over_s;
  return m;
}

/// Rocker angle psi [rad] in [0, pi).
inline double rockerAngle(const Motion& m) noexcept { return std::atan2(m.sin_psi, m.cos_psi); }

/// Directions are e^(i angle), angles counter-clockwise in the mechanism frame; rates per radian of crank angle.
/// mu = psi - beta is the transmission angle: sin(mu/2) = s/r0, cos(mu/2) = r/r0, mu' = c/r, with s, c, r of Motion.
/// A quantity `_over_s` is divided by s = sin(phi/2) without the division: it stays finite and exact at the blow.
struct LinkMotion {
  Motion rocker;
  Planar phi;    ///< crank direction A->B
  Planar beta;   ///< rod direction B->C
  Planar psi;    ///< rocker direction D->C
  Planar delta;  ///< e^(i (beta - phi))
  double sin_delta_over_s{};
  double sin_mu{}, cos_mu{}, sin_mu_over_s{};
  double v{};   ///< dbeta/dphi [-]
  double dv{};  ///< d2beta/dphi2 [1/rad]
  double dv_over_s{};
};

HAMMER_LOADS_INLINE LinkMotion linkMotion(const CrankRocker::Ratios& k, const Motion& m) noexcept {
  const double s = m.sin_half, c = m.cos_half, ss = s * s;
  LinkMotion l;
  l.rocker.sin_psi = m.sin_psi;  // one by one: copied as a block they would stay in memory
  l.rocker.cos_psi = m.cos_psi;
  l.rocker.u = m.u;
  l.rocker.du = m.du;
  l.rocker.sin_half = m.sin_half;
  l.rocker.cos_half = m.cos_half;
  l.rocker.r = m.r;
  l.rocker.inv_r = m.inv_r;
  l.rocker.sin_psi_over_s = m.sin_psi_over_s;
  l.rocker.du_over_s = m.du_over_s;
  const double sin_phi_over_s = 2.0 * c;
  l.phi = {1.0 - 2.0 * ss, s * sin_phi_over_s};
  l.psi = {m.cos_psi, m.sin_psi};
  l.sin_mu_over_s = k.two_over_r0_squared * m.r;
  l.sin_mu = s * l.sin_mu_over_s;
  l.cos_mu = 1.0 - k.two_over_r0_squared * ss;
  const double sin_beta_over_s = m.sin_psi_over_s * l.cos_mu - m.cos_psi * l.sin_mu_over_s;
  l.beta = {m.cos_psi * l.cos_mu + m.sin_psi * l.sin_mu, s * sin_beta_over_s};
  l.sin_delta_over_s = sin_beta_over_s * l.phi.re - l.beta.re * sin_phi_over_s;
  l.delta = {l.beta.re * l.phi.re + l.beta.im * l.phi.im, s * l.sin_delta_over_s};
  l.v = m.u - c * m.inv_r;
  l.dv_over_s = m.du_over_s + (0.5 * k.g) * m.inv_r * (m.inv_r * m.inv_r);
  l.dv = s * l.dv_over_s;
  return l;
}

HAMMER_LOADS_INLINE LinkMotion linkMotion(const CrankRocker& linkage, CrankAngle angle) noexcept {
  return linkMotion(linkage.ratios(), motion(linkage, angle));
}

/// Rod angle beta [rad] in (-pi, pi].
inline double rodAngle(const LinkMotion& l) noexcept { return std::atan2(l.beta.im, l.beta.re); }

/// Factors that convert each link's direction to its second time derivative.
struct LinkAccelerations {
  Planar crank, rod, rocker;  ///< i angle'' - angle'^2 [1/s2]
};

HAMMER_LOADS_INLINE LinkAccelerations linkAccelerations(const LinkMotion& l, double speed,
                                                        double acceleration) noexcept {
  const double ww = speed * speed, sww = l.rocker.sin_half * ww;
  const double rod_rate = l.v * speed, rocker_rate = l.rocker.u * speed;
  LinkAccelerations q;
  q.crank = {-ww, acceleration};
  q.rod = {-rod_rate * rod_rate, l.dv_over_s * sww + l.v * acceleration};
  q.rocker = {-rocker_rate * rocker_rate, l.rocker.du_over_s * sww + l.rocker.u * acceleration};
  return q;
}

/// Coupling of crank and rod, l1 m2 rho2 e^(i (beta - phi)) [kg m2]: its real part couples their rates.
HAMMER_LOADS_INLINE Planar linkCoupling(const Mechanism& mechanism, const LinkMotion& l) noexcept {
  return mechanism.moments().coupling * l.delta;
}

/// Accelerations that a turning hull adds to the links: Coriolis, centrifugal and Euler acceleration (model.md 3). A
/// mass at r from D that moves at r' relative to the hull gets r (i alpha - Omega^2) + 2 i Omega r' beside the
/// acceleration of D, which is part of the effective gravity. The loads are linear in it, so the terms are added. They
/// multiply directions like LinkAccelerations; a link that turns at w gets i alpha - Omega (Omega + 2 w).
struct TurningAccelerations {
  LinkAccelerations links;
  Planar hull;  ///< acceleration of points fixed to the hull [1/s2]
};

inline TurningAccelerations turningAccelerations(const LinkMotion& l, double speed, const HullMotion& hull) noexcept {
  const auto of = [&](double link_rate) {
    return Planar{-hull.rate * (hull.rate + 2.0 * link_rate), hull.acceleration};
  };
  return {{of(speed), of(l.v * speed), of(l.rocker.u * speed)}, of(0.0)};
}

/// Moments of all moving links about D as functions of the crank angle.
struct MomentsAboutD {
  double inertia{};           ///< J_D [kg m2]
  double half_slope{};        ///< half of dJ_D/dphi [kg m2/rad]
  double half_slope_slope{};  ///< derivative of half_slope by the crank angle [kg m2/rad2]
  double momentum{};          ///< angular momentum relative to the hull over crank speed [kg m2]
  double momentum_slope{};    ///< derivative of momentum by the crank angle [kg m2/rad]
};

/// Level rocker: J_D = I.
inline MomentsAboutD momentsAboutDRocker(const Mechanism& mechanism, const Motion& m) noexcept {
  const double inertia = mechanism.parameters().rocker_inertia_about_pivot;
  return {inertia, 0.0, 0.0, inertia * m.u, inertia * m.du};
}

/// Level linkage. Pin A is at -pivot.
inline MomentsAboutD momentsAboutDLinkage(const Mechanism& mechanism, const LinkMotion& l) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const LinkMoments& k = mechanism.moments();
  const Planar crank = k.crank * l.phi, rod = k.rod * l.beta, coupling = linkCoupling(mechanism, l);
  const Planar from_d = conj(k.pivot) * (crank + rod);
  const Planar by_angle = conj(k.pivot) * (crank + l.v * rod);
  const Planar by_angle_slope = conj(k.pivot) * (turned(crank + l.v * l.v * rod) + l.dv * rod);
  const double inertia_a = (p.crank_mass + p.rod_mass) * (k.pivot.re * k.pivot.re + k.pivot.im * k.pivot.im);
  const double u = l.rocker.u,
               swing = l.v - 1.0;  // speed of the connecting rod relative to the crank, over the crank's
  return {
      inertia_a - 2.0 * from_d.re + k.crank_inertia + k.rod_inertia + 2.0 * coupling.re + p.rocker_inertia_about_pivot,
      by_angle.im - swing * coupling.im, by_angle_slope.im - l.dv * coupling.im - swing * swing * coupling.re,
      k.crank_inertia + k.rod_inertia * l.v + p.rocker_inertia_about_pivot * u + (1.0 + l.v) * coupling.re -
          by_angle.re,
      k.rod_inertia * l.dv + p.rocker_inertia_about_pivot * l.rocker.du + l.dv * coupling.re -
          (1.0 + l.v) * swing * coupling.im - by_angle_slope.re};
}

}  // namespace hammer_loads
