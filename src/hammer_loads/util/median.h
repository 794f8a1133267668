/// Median of a list.
#pragma once

#include <algorithm>
#include <vector>

namespace hammer_loads {

/// Median, of an even number of values the smaller one of the middle; 0 of none.
inline double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace hammer_loads
