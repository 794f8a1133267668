/// Median of a list.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hammer_loads {

/// Median, of an even number of values the smaller one of the middle; 0 of none.
inline double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Standard deviation of normally distributed values, by the median of their absolute deviations from `middle`; robust
/// against few large ones.
inline double stdByMedian(std::vector<double> values, double middle) {
  constexpr double kMedianOfNormal = 0.6745;  // absolute value that half of a standard normal distribution is below
  for (double& value : values) value = std::abs(value - middle);
  return medianOf(std::move(values)) / kMedianOfNormal;
}

}  // namespace hammer_loads
