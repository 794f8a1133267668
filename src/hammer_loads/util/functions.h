/// Functions of the hot path: square, sine and cosine, exponential of small numbers, equal parts of a length.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/inline.h"

namespace hammer_loads {

constexpr double square(double x) noexcept { return x * x; }

struct SineCosine {
  double sine{};
  double cosine{};
};

/// Largest size of an angle for which the polynomials hold [rad]; half a crank's offset needs pi/2.
constexpr double kPolynomialAngle = 1.66;

/// |h| <= kPolynomialAngle [rad]. Relative error of the sine some 2e-16, also near 0; of the cosine 2e-16 of 1.
/// Chebyshev approximations of (sin h/h - 1)/h^2 and (cos h - 1 + h^2/2)/h^4 by h^2, truncated at 4e-17.
HAMMER_LOADS_INLINE SineCosine sineCosinePolynomial(double h) noexcept {
  const double x = h * h, x2 = x * x, x4 = x2 * x2;
  const double s01 = -0.16666666666666666 + 0.008333333333333295 * x;
  const double s23 = -0.00019841269841241072 + 2.75573192156296e-06 * x;
  const double s45 = -2.505210719309433e-08 + 1.605895139716198e-10 * x;
  const double s67 = -7.643189321827469e-13 + 2.7222439888465815e-15 * x;
  const double c01 = 0.041666666666666664 - 0.001388888888888887 * x;
  const double c23 = 2.480158730157288e-05 - 2.755731921979807e-07 * x;
  const double c45 = 2.0876756390360066e-09 - 1.1470699280427564e-11 * x;
  const double c67 = 4.7774863889868236e-14 - 1.517251054201796e-16 * x;
  const double s = (s01 + x2 * s23) + x4 * (s45 + x2 * s67);
  const double c = (c01 + x2 * c23) + x4 * (c45 + x2 * c67);
  return {h + h * x * s, (1.0 - 0.5 * x) + x2 * c};
}

/// Sine and cosine of any h.
HAMMER_LOADS_INLINE SineCosine sineCosine(double h) noexcept {
  if (std::abs(h) <= kPolynomialAngle) return sineCosinePolynomial(h);
  return {std::sin(h), std::cos(h)};
}

/// exp(x); of a small number exact to rounding at a tenth of the time.
inline double growth(double x) noexcept {
  constexpr double kNear = 2e-3;
  if (!(std::abs(x) < kNear)) return std::exp(x);
  return 1.0 + x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0)))));
}

/// Number of equal parts, at least 1; a part is at most an eighth longer than `longest`, so that a step of a nominal
/// length that is rounded or jitters has the parts of that length.
inline int partsOf(double length, double longest) noexcept {
  constexpr double kLonger = 1.125;
  return std::max(1, static_cast<int>(std::ceil(length / (kLonger * longest))));
}

}  // namespace hammer_loads
