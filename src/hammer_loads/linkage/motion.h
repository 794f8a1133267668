/// Motion of rod and rocker for a crank angle: closed forms without inverse trigonometry, exact at the blow.
///
/// Derived in doc/model.md from the half-angle relations of the change-point linkage; they equal P0 (2)-(5) but no term
/// cancels on either side of the blow. Relative error of u, u' and of the sines near the blow: some 1e-15 (measured
/// against 60 digits: test/linkage/motion_test.cpp).
#pragma once

#include <cmath>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/linkage/crank_rocker.h"

namespace hammer_loads {

/// Angles are counter-clockwise in the mechanism frame (model.md 1): psi = rocker from A->D, beta = rod,
/// mu = psi - beta the transmission angle. Rates are per radian of crank angle phi.
struct Motion {
  double sin_psi{}, cos_psi{};
  double u{};           ///< dpsi/dphi [-], P0 (4)
  double du{};          ///< d2psi/dphi2 [1/rad], P0 (5)
  double sin_half{};    ///< s = sin(phi/2) >= 0 within the turn
  double cos_half{};    ///< c = cos(phi/2), negative before the blow
  double r{};           ///< sqrt(lambda2 lambda3/lambda0 - s^2)
  double sin_psi_over_s{};  ///< sin psi/s, finite at the blow
  double du_over_s{};       ///< u'/s, finite at the blow
};

/// Shared by the scalar and the batch call, so that one formula serves both; s >= 0 and c >= 0 are the sine and cosine
/// of half the offset's size, `before` the side of the blow.
inline Motion motionFromHalfAngle(const CrankRocker::Ratios& k, double s, double c, bool before) noexcept {
  const double cc = c * c, ss = s * s;
  const double r = std::sqrt(k.g + cc);  // = sqrt(r0^2 - s^2), without the difference
  const double d = k.lambda0 * r + k.lambda3 * c;
  const double a = r + k.lambda2 * c;
  const double z = r + c;
  const double w = (k.lambda2 - 1.0) * ss - k.w0;
  // tan(psi/2) = p/q
  const double p_over_s = before ? d : k.sigma;
  const double p = p_over_s * s;
  const double q = before ? k.k_cos * cc + k.k_sin * ss : d;
  const double n = p * p + q * q;
  const double inv_n = 1.0 / n;
  const double inv_r = 1.0 / r;
  const double half_n_over_r = 0.5 * n * inv_r;

  Motion m;
  m.sin_psi_over_s = 2.0 * p_over_s * q * inv_n;
  m.sin_psi = s * m.sin_psi_over_s;
  m.cos_psi = (q - p) * (q + p) * inv_n;
  const double a_ratio = before ? w * d * d / a : k.sigma * a;
  m.u = k.lambda3 * a_ratio * inv_r * inv_n;
  const double lambda03 = k.lambda0 * k.lambda3;
  const double g_over_z = k.g / z;  // = r - c
  const double scale = before ? z * d * d / (k.sigma * k.sigma) : k.sigma * g_over_z;
  const double bracket = before ? lambda03 * a_ratio * z - k.lambda2 * k.sigma * g_over_z * half_n_over_r
                                : lambda03 * a * g_over_z - k.lambda2 * z * half_n_over_r;
  m.du_over_s = k.lambda3 * scale * bracket * (inv_r * inv_r) * (inv_n * inv_n);
  m.du = s * m.du_over_s;
  m.sin_half = s;
  m.cos_half = before ? -c : c;
  m.r = r;
  return m;
}

/// Motion at a crank angle. No allocation, no failure for any finite offset.
inline Motion motion(const CrankRocker& linkage, CrankAngle angle) noexcept {
  const bool before = angle.side == Side::kBeforeBlow;
  const double half = before ? -0.5 * angle.offset : 0.5 * angle.offset;
  return motionFromHalfAngle(linkage.ratios(), std::sin(half), std::cos(half), before);
}

/// Rocker angle psi [rad] in [0, pi).
inline double rockerAngle(const Motion& m) noexcept { return std::atan2(m.sin_psi, m.cos_psi); }

}  // namespace hammer_loads
