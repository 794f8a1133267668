/// Bounds on time, which only a quiet machine keeps.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

namespace hammer_loads::test {

/// .ci/nightly sets HAMMER_LOADS_NIGHTLY; in the ordinary run times are measured and reported, not judged. Never judged
/// are builds that are slow by intention.
inline bool timesCount() {
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  return std::getenv("HAMMER_LOADS_NIGHTLY") != nullptr;
#else
  return false;
#endif
}

/// time and limit in the same unit.
inline void expectTimeWithin(double time, double limit, const char* what) {
  if (timesCount()) {
    EXPECT_LE(time, limit) << what;
  }
}

}  // namespace hammer_loads::test
