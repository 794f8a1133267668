/// Whether an instant is closer to the blow than the crank's angle is known.
#pragma once

#include <cmath>

#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/crank/way_piece.h"
#include "hammer_loads/estimation/gates.h"

namespace hammer_loads {

/// The wrench jumps at the blow (MO-100: by 9 % of its peak), so there it is one of two values and nothing says which;
/// WrenchStamped has no deviation that could. A slow crank jumps by less than 1 %, one on the mirrored branch nowhere.
/// angle_deviation: of the crank [rad]; NaN: not known.
inline bool isBesideBlow(const CrankEstimate& crank, double angle_deviation) noexcept {
  const CrankPosition& at = crank.position;
  return std::abs(at.angle.offset) < gate::kUsual * angle_deviation && std::abs(crank.speed) > kSlowCrank &&
         !at.isMirrored();
}

}  // namespace hammer_loads
