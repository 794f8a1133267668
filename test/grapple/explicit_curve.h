/// Computes the grapple's whole configuration curve without iteration to 50 digits, as an oracle that shares nothing
/// with the code.
///
/// Seen from link 5 (O-E-D) the jaw's side DB is the crank of a four-bar D-B-C-E. Its angle psi gives B, then C by two
/// circles, A by similarity, the distance |OA| and with it rocker 1, the true orientation, H and the slider: every
/// quantity is an explicit function of psi, with derivatives by second-order jets. A fold is ds/dpsi = 0 and regular.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <optional>

#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads::test {

using Digits50 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

/// Value, first and second derivative by psi.
struct PsiJet {
  Digits50 v{0}, d{0}, dd{0};
  PsiJet() = default;
  PsiJet(const Digits50& value) : v(value) {}
  PsiJet(double value) : v(value) {}
  PsiJet(const Digits50& value, const Digits50& first, const Digits50& second) : v(value), d(first), dd(second) {}
};

inline PsiJet operator+(const PsiJet& a, const PsiJet& b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
inline PsiJet operator-(const PsiJet& a, const PsiJet& b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
inline PsiJet operator*(const PsiJet& a, const PsiJet& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
}
inline PsiJet inverse(const PsiJet& a) {
  const Digits50 r = 1 / a.v;
  return {r, -a.d * r * r, (2 * a.d * a.d * r - a.dd) * r * r};
}
inline PsiJet operator/(const PsiJet& a, const PsiJet& b) { return a * inverse(b); }
inline PsiJet sqrt(const PsiJet& a) {
  const Digits50 r = sqrt(a.v), h = a.d / (2 * r);
  return {r, h, (a.dd / 2 - h * h) / r};
}

struct PsiPoint {
  PsiJet x, y;
};
inline PsiPoint operator+(const PsiPoint& a, const PsiPoint& b) { return {a.x + b.x, a.y + b.y}; }
inline PsiPoint operator-(const PsiPoint& a, const PsiPoint& b) { return {a.x - b.x, a.y - b.y}; }
inline PsiPoint operator*(const PsiPoint& a, const PsiPoint& b) {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
inline PsiPoint operator*(const PsiJet& k, const PsiPoint& a) { return {k * a.x, k * a.y}; }
inline PsiPoint conj(const PsiPoint& a) { return {a.x, PsiJet{} - a.y}; }
inline PsiJet squared(const PsiPoint& a) { return a.x * a.x + a.y * a.y; }
inline PsiPoint across(const PsiPoint& a) { return {PsiJet{} - a.y, a.x}; }
inline PsiPoint polar(double length, double angle) {
  const Digits50 a(angle);
  return {PsiJet(Digits50(length) * cos(a)), PsiJet(Digits50(length) * sin(a))};
}

/// One configuration; x and y in the grapple frame.
struct ExplicitPose {
  PsiJet slider;
  PsiPoint h, a, b, c, d, e, p;

  PsiPoint edgeBySlider() const {  ///< .d = dP/ds, .dd = d2P/ds2 in v
    const auto convert = [this](const PsiJet& q) {
      const Digits50 first = q.d / slider.d;
      return PsiJet{q.v, first, (q.dd - first * slider.dd) / (slider.d * slider.d)};
    };
    return {convert(p.x), convert(p.y)};
  }
};

/// Signs that select a point of the two circles, a triangle O-O1-A and a slider position.
using Signs = std::array<int, 3>;

inline std::optional<ExplicitPose> explicitPose(const GrappleParameters& k, const Digits50& psi, const Signs& signs) {
  const PsiPoint d{PsiJet(k.od), {}}, e = polar(k.oe, k.doe);
  const PsiJet angle(psi, 1, 0);
  const Digits50 c = cos(psi), s = sin(psi);
  const PsiPoint b = d + PsiJet(k.bd) * PsiPoint{{c, -s, -c}, {s, c, -s}};
  // C: |BC| known from lever A-B-C, |CE| given.
  const PsiPoint bc_in_lever = polar(k.ac, k.bac) - PsiPoint{PsiJet(k.ab), {}};
  const PsiJet bc_squared = squared(bc_in_lever), ce_squared(Digits50(k.ce) * k.ce);
  const PsiPoint be = e - b;
  const PsiJet l = squared(be), along = (bc_squared - ce_squared + l) / (PsiJet(2.0) * l);
  const PsiJet h_squared = bc_squared / l - along * along;
  if (h_squared.v <= 0) return std::nullopt;
  const PsiPoint bc = along * be + PsiJet(double(signs[0])) * sqrt(h_squared) * across(be);
  // A follows by similarity: (A - B)/(C - B) is as in the lever.
  const PsiPoint ratio = PsiJet(-k.ab) / bc_squared * conj(bc_in_lever);
  const PsiPoint a = b + bc * ratio;
  // True position of A: |OA| from above, |O1A| given.
  const PsiPoint o1{PsiJet(k.o1.re), PsiJet(k.o1.im)};
  const PsiJet n = sqrt(squared(o1)), r_squared = squared(a);
  const PsiJet u = (r_squared + n * n - PsiJet(Digits50(k.o1a) * k.o1a)) / (PsiJet(2.0) * n);
  const PsiJet w_squared = r_squared - u * u;
  if (w_squared.v <= 0) return std::nullopt;
  const PsiPoint true_a = inverse(n) * o1 * PsiPoint{u, PsiJet(double(signs[1])) * sqrt(w_squared)};
  const PsiPoint turn = inverse(r_squared) * (true_a * conj(a));

  ExplicitPose pose;
  pose.a = true_a;
  pose.b = b * turn;
  pose.c = (b + bc) * turn;
  pose.d = d * turn;
  pose.e = e * turn;
  pose.p = pose.b + (pose.d - pose.b) * (PsiJet(Digits50(1) / k.bd) * polar(k.bp, k.dbp));
  pose.h = o1 + PsiJet(Digits50(1) / k.o1a) * (true_a - o1) * polar(k.o1h, k.ho1a);
  const PsiJet gx = PsiJet(k.slider_x) - pose.h.x, gy_squared = PsiJet(Digits50(k.gh) * k.gh) - gx * gx;
  if (gy_squared.v <= 0) return std::nullopt;
  pose.slider = pose.h.y + PsiJet(double(signs[2])) * sqrt(gy_squared);
  return pose;
}

/// A point of the curve, given by psi and the signs.
struct CurvePlace {
  Digits50 psi;
  Signs signs{};
};

/// Returns psi and signs of a pose computed in double precision, or nothing if no combination is close.
inline std::optional<CurvePlace> placeOf(const GrappleParameters& k, const GrappleMotion& m) {
  const Digits50 psi(angleOf((m.b - m.d) * conj(m.d)));
  std::optional<CurvePlace> best;
  Digits50 least = 1e-4;
  for (int i = 0; i < 8; ++i) {
    const Signs signs{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
    const auto pose = explicitPose(k, psi, signs);
    if (!pose) continue;
    const Digits50 miss = abs(pose->slider.v - m.slider) + abs(pose->p.x.v - m.p.re) + abs(pose->p.y.v - m.p.im);
    if (miss >= least) continue;
    least = miss;
    best = CurvePlace{psi, signs};
  }
  return best;
}

/// Returns the exact pose at the slider position of a pose computed in double precision.
inline std::optional<ExplicitPose> exactPoseOf(const GrappleParameters& k, const GrappleMotion& m) {
  auto place = placeOf(k, m);
  if (!place) return std::nullopt;
  for (int i = 0; i < 12; ++i) {
    const auto pose = explicitPose(k, place->psi, place->signs);
    if (!pose) return std::nullopt;
    const Digits50 step = (pose->slider.v - Digits50(m.slider)) / pose->slider.d;
    if (abs(step) < Digits50("1e-45")) return pose;
    if (abs(step) > 0.1) return std::nullopt;
    place->psi -= step;
  }
  return explicitPose(k, place->psi, place->signs);
}

/// Returns the exact fold next to a pose, where ds/dpsi = 0.
inline std::optional<ExplicitPose> exactFoldNear(const GrappleParameters& k, const GrappleMotion& m) {
  auto place = placeOf(k, m);
  if (!place) return std::nullopt;
  std::optional<ExplicitPose> pose;
  for (int i = 0; i < 20; ++i) {
    pose = explicitPose(k, place->psi, place->signs);
    if (!pose) return std::nullopt;
    const Digits50 step = pose->slider.d / pose->slider.dd;
    if (abs(step) > 0.1) return std::nullopt;
    place->psi -= step;
    if (abs(step) < Digits50("1e-45")) break;
  }
  return pose;
}

/// Largest errors of motions against the exact curve, relative to max(1, |value|): position, first, second.
struct CurveErrors {
  double position{}, first{}, second{};
  void add(const GrappleMotion& m, const ExplicitPose& exact) {
    const PsiPoint p = exact.edgeBySlider();
    const auto error = [](double value, const Digits50& truth) {
      const Digits50 size = abs(truth) > 1 ? Digits50(abs(truth)) : Digits50(1);
      return static_cast<double>(abs(value - truth) / size);
    };
    position = std::max({position, error(m.p.re, p.x.v), error(m.p.im, p.y.v)});
    first = std::max({first, error(m.dp.re, p.x.d), error(m.dp.im, p.y.d)});
    second = std::max({second, error(m.ddp.re, p.x.dd), error(m.ddp.im, p.y.dd)});
  }
};

}  // namespace hammer_loads::test
