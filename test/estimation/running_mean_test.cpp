// Running means, latches and gates.
#include "hammer_loads/estimation/running_mean.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <random>

#include "hammer_loads/estimation/gates.h"

namespace hammer_loads::test {
namespace {

/// A full mean forgets: n samples after a unit step it is 1 - (1 - 1/length)^n.
TEST(RunningMean, FollowsAStepByItsLength) {
  RunningMean<> mean(50.0, 0.0, 50.0);
  for (int i = 0; i < 50; ++i) mean.add(1.0);
  EXPECT_NEAR(mean.mean(), 1.0 - std::pow(1.0 - 1.0 / 50.0, 50), 1e-14);
}

/// Weights are durations. The mean does not depend on the length of the steps, apart from their resolution.
TEST(RunningMean, TakesTimesForWeights) {
  RunningMean<Eigen::Vector2d> fine(2.0, Eigen::Vector2d::Zero()), coarse = fine;
  const Eigen::Vector2d value(3.0, -1.0);
  for (int i = 0; i < 1000; ++i) fine.add(value, 0.001);
  for (int i = 0; i < 10; ++i) coarse.add(value, 0.1);
  EXPECT_TRUE(fine.mean().isApprox(value, 1e-12));
  EXPECT_TRUE(coarse.mean().isApprox(value, 1e-12));
  EXPECT_NEAR(fine.count(), 1.0, 1e-12);
  coarse.add(-value, 100.0);  // longer than the memory: only this value remains
  EXPECT_TRUE(coarse.mean().isApprox(-value, 1e-12));
}

TEST(Latch, EngagesHighAndReleasesLow) {
  Latch latch(2.0, 1.0);
  EXPECT_FALSE(latch.follow(1.5));
  EXPECT_TRUE(latch.follow(2.5));
  EXPECT_TRUE(latch.follow(1.5));
  EXPECT_FALSE(latch.follow(1.0));
  EXPECT_FALSE(latch.follow(1.5));
  EXPECT_TRUE(latch.follow(3.0));
  EXPECT_FALSE(latch.follow(std::numeric_limits<double>::quiet_NaN()));
}

/// Each gate is exceeded at its nominal rate in a million draws.
TEST(Gate, NoiseExceedsItAtTheStatedRate) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 3.0);
  int usual = 0, rare = 0, very_rare = 0, impossible = 0;
  for (int i = 0; i < 1000000; ++i) {
    const double x = normal(random);
    usual += exceeds(x, 9.0, gate::kUsual), rare += exceeds(x, 9.0, gate::kRare);
    very_rare += exceeds(x, 9.0, gate::kVeryRare), impossible += exceeds(x, 9.0, gate::kImpossible);
  }
  EXPECT_NEAR(usual, 45500, 4.0 * std::sqrt(45500));
  EXPECT_NEAR(rare, 2700, 4.0 * std::sqrt(2700));
  EXPECT_NEAR(very_rare, 63, 4.0 * std::sqrt(63));
  EXPECT_LE(impossible, 5);
}

TEST(Gate, PassesNotANumber) {
  EXPECT_FALSE(exceeds(std::numeric_limits<double>::quiet_NaN(), 1.0, gate::kUsual));
  EXPECT_TRUE(exceeds(5.1, 1.0, gate::kImpossible));
  EXPECT_FALSE(exceeds(-4.9, 1.0, gate::kImpossible));
  EXPECT_EQ(weightWithin(3.0, 2.9, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(weightWithin(3.0, 6.0, 1.0) * 36.0, 9.0);
}

}  // namespace
}  // namespace hammer_loads::test
