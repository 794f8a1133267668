/// What the estimate of a whole session must keep.
#pragma once

#include <gtest/gtest.h>

#include "hammer_loads/bench/session_run.h"

namespace hammer_loads::test {

struct SessionBounds {
  double rms, peak, impulse, blow_time, energy;
};
constexpr SessionBounds kBounds1kHz{0.0025, 0.012, 0.006, 1e-3, 0.02};
constexpr SessionBounds kBounds100Hz{0.004, 0.02, 0.012, 1.5e-3, 0.025};

inline void expectWithin(const accuracy::SessionErrors& e, const SessionBounds& bounds) {
  EXPECT_LE(e.x.rms, bounds.rms);
  EXPECT_LE(e.z.rms, bounds.rms);
  EXPECT_LE(e.torque.rms, bounds.rms);
  EXPECT_LE(e.turn_peak, bounds.peak);
  EXPECT_LE(e.turn_impulse, bounds.impulse);
  EXPECT_LE(e.blow_time, bounds.blow_time);
  EXPECT_LE(e.energy, bounds.energy);
  EXPECT_EQ(e.missed_blows, 0);
  EXPECT_EQ(e.extra_blows, 0);
}

}  // namespace hammer_loads::test
