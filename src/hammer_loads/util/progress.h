/// How much of a long work is done.
#pragma once

#include <functional>

namespace hammer_loads {

/// Takes the part done, in [0, 1]; empty: no progress is shown.
using Progress = std::function<void(double)>;

/// Of a piece of the work that takes it from one part to another.
inline Progress piece(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [whole, from, to](double part) { whole(from + (to - from) * part); };
}

inline void report(const Progress& progress, double part) {
  if (progress) progress(part);
}

}  // namespace hammer_loads
