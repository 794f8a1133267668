/// The crank's position over many turns.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "hammer_loads/linkage/crank_angle.h"

namespace hammer_loads {

/// Unwound crank position: 2 pi * blow + angle.offset [rad]. Keeping the whole turns apart means that days of work cost
/// no precision. `blow` counts passages of the blow; the nearest one is at offset 0.
struct CrankPosition {
  std::int64_t blow{};
  CrankAngle angle;

  /// Moves to the neighbouring blow's half turn when the offset leaves [-pi, pi]; never crosses a blow.
  void renormalise() noexcept {
    if (angle.side == Side::kAfterBlow && angle.offset > 0.5 * kTwoPi) {
      ++blow;
      angle = {angle.offset - kTwoPi, Side::kBeforeBlow};
    } else if (angle.side == Side::kBeforeBlow && angle.offset < -0.5 * kTwoPi) {
      --blow;
      angle = {angle.offset + kTwoPi, Side::kAfterBlow};
    }
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

  /// Number of blows passed since phi = 0: blow b is passed once the position is at or after it.
  std::int64_t blowsPassed() const noexcept { return angle.side == Side::kAfterBlow ? blow : blow - 1; }
};

/// this - other [rad].
inline double difference(const CrankPosition& a, const CrankPosition& b) noexcept {
  return static_cast<double>(a.blow - b.blow) * kTwoPi + (a.angle.offset - b.angle.offset);
}

}  // namespace hammer_loads
