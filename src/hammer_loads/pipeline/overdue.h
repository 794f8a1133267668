/// A sensor whose next reading should have come.
#pragma once

#include <cmath>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// For how long more than one reading should have come [s]; below 0: not yet. since: the last one; interval: before it.
inline double overdue(double since, double interval) noexcept {
  constexpr double kIntervals = 2.0;
  return since - kIntervals * interval;
}

/// Part of what the last reading showed that is no longer true, 0 to 1. overdue: as above [s].
inline double forgottenPart(double overdue) noexcept {
  return overdue > 0.0 ? -std::expm1(-overdue / look_back::kHeld) : 0.0;
}

}  // namespace hammer_loads
