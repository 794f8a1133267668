/// Equal parts of a length.
#pragma once

#include <algorithm>
#include <cmath>

namespace hammer_loads {

/// Number of equal parts, at least 1; a part is at most an eighth longer than `longest`, so that a step of a nominal
/// length that is rounded or jitters has the parts of that length.
inline int partsOf(double length, double longest) noexcept {
  constexpr double kLonger = 1.125;
  return std::max(1, static_cast<int>(std::ceil(length / (kLonger * longest))));
}

}  // namespace hammer_loads
