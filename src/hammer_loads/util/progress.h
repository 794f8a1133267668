/// Progress of a long computation.
#pragma once

#include <functional>

namespace hammer_loads {

/// Takes the part done, in [0, 1]; empty: no progress is shown.
using Progress = std::function<void(double)>;

/// Progress of a part of the work that runs from one fraction to another.
inline Progress piece(const Progress& whole, double from, double to) {
  if (!whole) return {};
  return [whole, from, to](double part) { whole(from + (to - from) * part); };
}

inline void report(const Progress& progress, double part) {
  if (progress) progress(part);
}

}  // namespace hammer_loads
