/// Crank angle that keeps full precision beside the blow.
#pragma once

#include <cmath>

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
  /// pi) and 6e-33 rad per turn, instead of 2.4e-16 per turn.
  static double wrapToPi(double phi) noexcept {
    constexpr double kTwoPiHigh = 6.283185307179586232e+00;
    constexpr double kTwoPiLow = 2.449293598294706414e-16;
    const double turns = std::nearbyint(phi / kTwoPiHigh);
    return std::fma(-turns, kTwoPiLow, std::fma(-turns, kTwoPiHigh, phi));
  }
};

/// An offset from the blow [rad] that the side does not have.
inline bool isBeyond(Side side, double offset) noexcept {
  return side == Side::kBeforeBlow ? offset > 0.0 : offset < 0.0;
}

}  // namespace hammer_loads
