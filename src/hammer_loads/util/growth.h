/// Exponentials of what changes little from step to step.
#pragma once

#include <cmath>

namespace hammer_loads {

/// exp(x); of a small number exact to rounding at a tenth of the time.
inline double growth(double x) noexcept {
  constexpr double kNear = 2e-3;
  if (!(std::abs(x) < kNear)) return std::exp(x);
  return 1.0 + x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0)))));
}

}  // namespace hammer_loads
