/// How a path is cut into smooth pieces that end at the blow; for a rigid and a flexible shaft alike.
#pragma once

#include <cmath>

#include "hammer_loads/linkage/crank_angle.h"

namespace hammer_loads {

constexpr double kMaxStepAngle = 0.04;  ///< [rad] of the crank in one piece
// Guard: CrankDynamics.PassesTheBlowInOneStepAsInMany of kMaxStepAngle
constexpr int kMaxSteps = 4096;  ///< bounds the work for absurd speeds; steps get longer beyond it
// Numerical: kMaxSteps
/// [rad/s]: a slower crank is moved by friction and stopped by the tool; nothing jumps there.
constexpr double kSlowCrank = 5.0;
// Guard: BesideBlow.IsWhereSomethingJumps of kSlowCrank
/// [rad/s]: a crank that creeps over the blow has no defined instant of passing it.
constexpr double kCreeping = 1.0;
// Guard: CrankDynamics.ACrankThatCreepsOverTheBlowHasNoInstantOfPassingIt of kCreeping
/// So often in one way: then both sides push it back to the other, and it stays at the blow.
constexpr int kMostCreepingPasses = 8;
// Guard: FlexibleShaft.WhereBothSidesPushItBackItPassesAFewTimesOnly of kMostCreepingPasses

/// Of the way.
struct WayPiece {
  double used;   ///< of its time [s]
  bool at_blow;  ///< ends there
};

/// An offset from the blow [rad] that the side does not have.
inline bool isBeyond(Side side, double offset) noexcept {
  return side == Side::kBeforeBlow ? offset > 0.0 : offset < 0.0;
}

/// Part of the step dt after which the crank is at the blow: safeguarded secant on the smooth continuation.
/// offset_after(t): offset from the blow [rad] after t of dt; start, end: at both ends, of different signs.
template <typename Function>
double timeToBlow(const Function& offset_after, double start, double end, double dt) noexcept {
  double low = 0.0, high = dt, f_low = start, f_high = end;
  double t = 0.0;
  for (int i = 0; i < 8; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = offset_after(t);
    if (std::abs(f) < 1e-13) break;
    const bool before = std::signbit(f) == std::signbit(f_low);
    (before ? low : high) = t;
    (before ? f_low : f_high) = f;
  }
  return t;
}

}  // namespace hammer_loads
