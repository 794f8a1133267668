/// Whether an instant is closer to the blow than the crank's angle is known.
#pragma once

#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/gates.h"

namespace hammer_loads {

/// Of the crank's angle from the blow [rad]: its own, and by what the readings say that the zero is wrong, or that a
/// rod which gives lets the rocker strike later. Through a coupling they say little of the zero: what they leave open.
/// angle_deviation: its own [rad]; NaN: not known.
inline double deviationFromBlow(const CrankTracker& tracker, double angle_deviation) noexcept {
  const CrankFilter* filter = tracker.filter();
  if (filter == nullptr) return angle_deviation;
  const ConstantErrors& errors = filter->constantErrors();
  if (filter->belief().motor) return std::hypot(angle_deviation, errors.zeroLeftOpen());
  return std::hypot(angle_deviation, filter->rodEvidence().gives() ? errors.zeroLooks() : errors.zeroSeen());
}

/// The wrench jumps at the blow (MO-100: Fx by nearly all of its peak), so there it is one of two values and nothing
/// says which; WrenchStamped has no deviation that could. A slow crank jumps by less than 1 %, one on the mirrored
/// branch nowhere. deviation: of the crank from the blow [rad]; NaN: not known. gate: so many of them.
inline bool isBesideBlow(const CrankEstimate& crank, double deviation, double gate = gate::kUsual) noexcept {
  const CrankPosition& at = crank.position;
  return std::abs(at.angle.offset) < gate * deviation && std::abs(crank.speed) > kSlowCrank && !at.isMirrored();
}

}  // namespace hammer_loads
