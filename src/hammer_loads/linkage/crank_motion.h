/// Crank angle with full precision near the blow, crank position over many revolutions, and crank motion.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Side of the blow (crank angle 0 mod 2 pi) to which a position belongs. The linkage has a change point there: its
/// transfer functions jump, so the blow itself has two states.
enum class Side { kAfterBlow, kBeforeBlow };

constexpr Side opposite(Side side) noexcept { return side == Side::kAfterBlow ? Side::kBeforeBlow : Side::kAfterBlow; }

/// Crank angle as its offset from the nearest blow: exact however close to the blow, for any winding.
///
/// With phi the crank angle counter-clockwise from A->D (model.md 1): offset = phi - 2 pi n [rad].
/// After the blow offset is normally in [0, pi], before it in [-pi, 0]. An offset of the other sign is the smooth
/// continuation of that side's branch past the blow (needed to find the blow's instant by root search).
struct CrankAngle {
  double offset{};  ///< [rad]
  Side side{Side::kAfterBlow};

  /// From an angle of any winding [rad]. 0 counts as after the blow; the double next to 2 pi lies 2.4e-16 before it.
  static CrankAngle fromAngle(double phi) noexcept { return fromOffset(wrapToPi(phi)); }

  /// From the offset to the nearest blow [rad], in [-pi, pi]; zero counts as after the blow.
  static CrankAngle fromOffset(double offset) noexcept {
    return {offset, offset < 0.0 ? Side::kBeforeBlow : Side::kAfterBlow};
  }

  friend bool operator==(const CrankAngle& a, const CrankAngle& b) noexcept {
    return a.offset == b.offset && a.side == b.side;
  }

  /// phi - 2 pi n in [-pi, pi] [rad], with 2 pi in two parts: error below the rounding of the result (for large n: of
  /// pi) and 6e-33 rad per revolution, instead of 2.4e-16.
  static double wrapToPi(double phi) noexcept {
    constexpr double kTwoPiHigh = 6.283185307179586232e+00;
    constexpr double kTwoPiLow = 2.449293598294706414e-16;
    const double turns = std::nearbyint(phi / kTwoPiHigh);
    return std::fma(-turns, kTwoPiLow, std::fma(-turns, kTwoPiHigh, phi));
  }
};

/// Returns true for an offset from the blow [rad] that is not on the given side.
inline bool isBeyond(Side side, double offset) noexcept {
  return side == Side::kBeforeBlow ? offset > 0.0 : offset < 0.0;
}

struct CrankMotion {
  CrankAngle angle;
  double speed{};         ///< w [rad/s], positive counter-clockwise in (xi, eta)
  double acceleration{};  ///< e [rad/s2]
};

/// Unwound crank position: 2 pi * blow + angle.offset [rad]. Whole revolutions are kept apart, so that days of work
/// cost no precision. `blow` counts passages of the blow; the nearest one is at offset 0.
///
/// A rocker that meets no tool passes the blow smoothly onto the mirrored branch, psi(phi) = -psi(2 pi - phi), and
/// returns a revolution later just as smoothly: there the offset has the other sign than its side's.
struct CrankPosition {
  std::int64_t blow{};
  CrankAngle angle;

  bool isMirrored() const noexcept { return angle.side == Side::kBeforeBlow ? angle.offset > 0.0 : angle.offset < 0.0; }

  /// Moves to the half revolution of the neighbouring blow when the offset leaves [-pi, pi]; never crosses a blow.
  void renormalise() noexcept {
    if (std::abs(angle.offset) <= 0.5 * kTwoPi) return;
    const bool up = angle.offset > 0.0;
    blow += up ? 1 : -1;
    angle.offset += up ? -kTwoPi : kTwoPi;
    angle.side = opposite(angle.side);
  }

  /// Turns by delta [rad], |delta| < pi, on the branch where it stands or its smooth continuation.
  void slide(double delta) noexcept {
    angle.offset += delta;
    renormalise();
  }

  /// Turns by delta [rad], passing the blow when the offset changes sign. A delta beyond 1e15 rad, as from a diverged
  /// estimate, results in NaN.
  void turn(double delta) noexcept {
    if (delta == 0.0) return;  // at the blow itself the side must not change
    const double offset = angle.offset + delta;
    if (!(std::abs(offset) < 1e15)) {
      angle.offset = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    blow += static_cast<std::int64_t>(std::nearbyint(offset / kTwoPi));
    angle = CrankAngle::fromAngle(offset);
  }

  /// Number of blows passed since phi = 0, with or without contact: blow b is passed once the position is at or after
  /// it.
  std::int64_t blowsPassed() const noexcept {
    const bool after = angle.offset == 0.0 ? angle.side == Side::kAfterBlow : angle.offset > 0.0;
    return after ? blow : blow - 1;
  }
};

/// Difference of two positions, a less b [rad].
inline double difference(const CrankPosition& a, const CrankPosition& b) noexcept {
  return static_cast<double>(a.blow - b.blow) * kTwoPi + (a.angle.offset - b.angle.offset);
}

}  // namespace hammer_loads
