/// Monotonic clock for ages and rates in reports.
#pragma once

#include <chrono>

namespace hammer_loads {

/// [s]
inline double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace hammer_loads
