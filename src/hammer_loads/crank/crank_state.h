/// The crank's position over many turns.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "hammer_loads/linkage/crank_angle.h"

namespace hammer_loads {

/// Unwound crank position: 2 pi * blow + angle.offset [rad]. Keeping the whole turns apart means that days of work cost
/// no precision. `blow` counts passages of the blow; the nearest one is at offset 0.
///
/// A rocker that meets no tool passes the blow smoothly onto the mirrored branch, psi(phi) = -psi(2 pi - phi), and
/// comes back a turn later just as smoothly: there the offset has the other sign than its side's.
struct CrankPosition {
  std::int64_t blow{};
  CrankAngle angle;

  bool isMirrored() const noexcept { return angle.side == Side::kBeforeBlow ? angle.offset > 0.0 : angle.offset < 0.0; }

  /// Moves to the neighbouring blow's half turn when the offset leaves [-pi, pi]; never crosses a blow.
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

  /// Turns by delta [rad], passing the blow when the offset changes sign. A delta beyond 1e15 rad, which a diverged
  /// estimate may ask for, leaves no number.
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
