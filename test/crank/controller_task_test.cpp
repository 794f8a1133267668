// Recognition of a controller's task by the ages of its readings.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/crank/stamp_sequence.h"

namespace hammer_loads {
namespace {

/// Period that is found after ten seconds [s]. Readings are sent every `interval` [s] with a stamp that jitters and an
/// innovation of the given noise [s]; a task of period `task` [s] took them, 0: they were taken when they were sent.
double periodOf(double interval, double task, double jitter, double noise) {
  ControllerTask found;
  std::mt19937 random(5);
  std::normal_distribution<> normal;
  for (int i = 1; i * interval < 10.0; ++i) {
    const double sent = i * interval, stamp = sent + jitter * normal(random);
    const double taken = task > 0.0 ? 0.3e-3 + task * std::floor((sent - 0.3e-3) / task) : sent;
    found.add(std::int64_t{1700000000000000000} + std::llround(1e9 * stamp), taken - stamp + noise * normal(random));
  }
  return found.period();
}

TEST(ControllerTask, ShowsByTheAgesOfItsReadings) {
  EXPECT_EQ(periodOf(0.01, 0.004, 0.3e-3, 0.2e-3), 0.004);
  EXPECT_EQ(periodOf(0.01, 0.0040002, 0.3e-3, 0.2e-3), 0.004);
  EXPECT_EQ(periodOf(0.01, 0.003, 0.0, 0.2e-3), 0.003);
  EXPECT_EQ(periodOf(0.01, 0.008, 1e-3, 0.5e-3), 0.008);
  EXPECT_EQ(periodOf(0.005, 0.004, 0.3e-3, 0.2e-3), 0.004);
  EXPECT_EQ(periodOf(0.001, 0.004, 0.0, 0.2e-3), 0.004);
}

/// Equal intervals lie on every grid that divides them.
TEST(ControllerTask, IsNotFoundInStampsThatJitter) {
  for (const double interval : {0.001, 0.002, 0.004, 0.005, 0.008, 0.01, 0.0125, 0.02})
    for (const double jitter : {0.05 * interval, 0.1 * interval, 0.3 * interval})
      for (const double noise : {0.05e-3, 0.5e-3}) EXPECT_EQ(periodOf(interval, 0.0, jitter, noise), 0.0) << interval;
}

TEST(ControllerTask, ShowsByReadingsThatRepeat) {
  ControllerTask found;
  for (int i = 1; i < 2000; ++i) {
    const std::int64_t stamp = i * std::int64_t{1000000};
    if (i % 4 == 0)
      found.add(stamp, 0.0);
    else
      found.repeat(stamp);
  }
  EXPECT_NEAR(found.period(), 0.004, 0.0002);
}

}  // namespace
}  // namespace hammer_loads
