/// Detection of an overdue reading.
#pragma once

#include <cmath>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// Time since a second reading was due [s]; negative before that. since: time of the last reading; interval: time
/// between the last two.
inline double overdue(double since, double interval) noexcept {
  constexpr double kIntervals = 2.0;
  return since - kIntervals * interval;
}

/// Part of the last reading that is no longer valid, 0 to 1. overdue: as above [s].
inline double forgottenPart(double overdue) noexcept {
  return overdue > 0.0 ? -std::expm1(-overdue / look_back::kHeld) : 0.0;
}

}  // namespace hammer_loads
