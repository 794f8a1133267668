// Which stamps are rounded, and by how much.
#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/crank/stamp_sequence.h"

namespace hammer_loads {
namespace {

/// Samples at `rate` [Hz] whose instants scatter by 30 us, stamped in steps [ns].
double roundingOf(double rate, std::int64_t step, std::int64_t scatter = 30000) {
  StampRounding rounding;
  std::mt19937 random(9);
  std::normal_distribution<> normal;
  std::int64_t last = 0;
  for (int i = 1; i < 2000; ++i) {
    const double instant = 1e9 * i / rate + static_cast<double>(scatter) * normal(random);
    const std::int64_t stamp = static_cast<std::int64_t>(instant) / step * step;
    rounding.add(stamp - last);
    last = stamp;
  }
  return rounding.step();
}

TEST(StampRounding, FindsTheStep) {
  EXPECT_EQ(roundingOf(1000.0, 1000000), 1e-3);
  EXPECT_EQ(roundingOf(200.0, 1000000), 1e-3);
  EXPECT_EQ(roundingOf(330.0, 100000), 1e-4);
  EXPECT_EQ(roundingOf(90.0, 10000000), 1e-2);
}

TEST(StampRounding, FineStampsHaveNoRounding) {
  EXPECT_EQ(roundingOf(1000.0, 1), 0.0);
  EXPECT_EQ(roundingOf(1000.0, 10000), 0.0);
}

/// A controller that samples by its own clock stamps whole milliseconds and is right.
TEST(StampRounding, EvenStepsMayBeExact) { EXPECT_EQ(roundingOf(1000.0, 1000000, 0), 0.0); }

}  // namespace
}  // namespace hammer_loads
