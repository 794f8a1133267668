/// Motion of rod and rocker for a crank angle: closed forms without inverse trigonometry, exact at the blow.
///
/// Derived in doc/model.md from the half-angle relations of the change-point linkage; they equal P0 (2)-(5) but no term
/// cancels on either side of the blow. Relative error of u, u' and of the sines near the blow: some 1e-15 (measured
/// against 100 digits: test/linkage/motion_test.cpp).
#pragma once

#include <cmath>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/crank_rocker.h"
#include "hammer_loads/util/sine_cosine.h"

namespace hammer_loads {

/// Angles are counter-clockwise in the mechanism frame (model.md 1): psi = rocker from A->D, beta = rod,
/// mu = psi - beta the transmission angle. Rates are per radian of crank angle phi.
struct Motion {
  double sin_psi{}, cos_psi{};
  double u{};               ///< dpsi/dphi [-], P0 (4)
  double du{};              ///< d2psi/dphi2 [1/rad], P0 (5)
  double sin_half{};        ///< s = sin(phi/2) >= 0 within the turn
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

}  // namespace hammer_loads
