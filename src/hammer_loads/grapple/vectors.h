/// Plane vectors for the grapple, beyond linkage/planar.h.
///
/// Grapple frame: origin = pivot O on the axis of symmetry, +x (re) towards the right jaw, +y (im) up, angles
/// counter-clockwise.
#pragma once

#include <cmath>

#include "hammer_loads/linkage/planar.h"

namespace hammer_loads {

constexpr Planar operator-(Planar a) noexcept { return {-a.re, -a.im}; }
constexpr double dot(Planar a, Planar b) noexcept { return a.re * b.re + a.im * b.im; }
/// z component of a x b.
constexpr double cross(Planar a, Planar b) noexcept { return a.re * b.im - a.im * b.re; }
constexpr double squaredNorm(Planar a) noexcept { return dot(a, a); }
inline double norm(Planar a) noexcept { return std::sqrt(squaredNorm(a)); }
/// Unit vector at an angle [rad] from +x.
inline Planar direction(double angle) noexcept { return {std::cos(angle), std::sin(angle)}; }
/// Angle of a vector from +x [rad], in [-pi, pi].
inline double angleOf(Planar a) noexcept { return std::atan2(a.im, a.re); }
/// Seen in a mirror on the axis of symmetry: right jaw to left jaw.
constexpr Planar mirrored(Planar a) noexcept { return {-a.re, a.im}; }

}  // namespace hammer_loads
