// What the crank's filter learns beside its state: how far, how fast and within which bounds, each within a factor of
// 1.25 of what is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/blow_history.h"
#include "hammer_loads/crank/consistency.h"
#include "hammer_loads/crank/supply.h"
#include "hammer_loads/estimation/timing_noise.h"

namespace hammer_loads {
namespace {

void expectAbout(double value, double said) {
  EXPECT_GT(value, 0.8 * said);
  EXPECT_LT(value, 1.25 * said);
}

TEST(LearnedNumbers, ConsistencyIsAMeanOfFiveHundred) {
  Consistency consistency;
  for (int i = 0; i < 2000; ++i) consistency.add(0.0);
  consistency.add(1.0);
  expectAbout(consistency.mean(), 1.0 / 500.0);
  consistency.add(1e9);
  expectAbout(consistency.mean(), 100.0 / 500.0);
  StrikeConsistency strikes;
  for (int turn = 0; turn < 2; ++turn) {
    strikes.add(1e9);
    strikes.endHalfTurn();
  }
  expectAbout(strikes.mean(), 100.0);
}

/// Samples that are missing count as what was before: 1, and after a restart what had been found.
TEST(LearnedNumbers, AYoungConsistencyIsAsDoubtfulAsTheOneBefore) {
  Consistency consistency;
  for (int i = 0; i < 50; ++i) consistency.add(9.0);
  expectAbout(consistency.doubt(), 1.0 + 8.0 * 50.0 / 200.0);
  EXPECT_TRUE(std::isnan(consistency.mean()));
  for (int i = 0; i < 150; ++i) consistency.add(9.0);
  expectAbout(consistency.doubt(), 9.0);
  consistency.restart();
  expectAbout(consistency.doubt(), 9.0);
  EXPECT_TRUE(std::isnan(consistency.mean()));
  for (int i = 0; i < 100; ++i) consistency.add(1.0);
  expectAbout(consistency.doubt(), 5.0);
  for (int i = 0; i < 100; ++i) consistency.add(1.0);
  expectAbout(consistency.doubt(), 1.0);
}

/// A supply that kept its sign for long, while stamps were exact.
TEST(LearnedNumbers, TheSupplysWalk) {
  SupplyRoughness supply;
  for (int i = 0; i < 100; ++i) supply.learn(1.0, 1.0, 0.0);
  supply.learn(1.0, 1.0, 1.0);
  expectAbout(supply.factor() - 1.0, 0.005 / (1.0 - 0.85));
  for (int i = 0; i < 1000; ++i) supply.learn(1.0, 1.0, 1.0);
  expectAbout(supply.factor(), 3.0);
  for (int i = 0; i < 10000; ++i) supply.learn(i % 2 == 0 ? 1.0 : -1.0, 1.0, 1.0);
  expectAbout(supply.factor(), 0.25);
}

/// Innovations that alternate are as large as stamps with this variance make them.
void jitter(TimingNoise& noise, double variance, int samples) {
  constexpr double kSpeed = 30.0, kOther = 1e-6;  // [rad/s], [rad2]
  for (int i = 0; i < samples; ++i) {
    const double size = std::sqrt(0.5 * (kOther + kSpeed * kSpeed * variance));
    noise.learn(i % 2 == 0 ? size : -size, kOther + kSpeed * kSpeed * noise.variance(), kSpeed);
  }
}

TEST(LearnedNumbers, TheStampsJitterWithinTwoHundredSamples) {
  constexpr double kBefore = 2.5e-7, kAfter = 3.0e-7;  // [s2]
  TimingNoise noise(std::sqrt(kBefore));
  jitter(noise, kBefore, 6000);
  ASSERT_NEAR(noise.variance(), kBefore, 1e-3 * kBefore);
  jitter(noise, kAfter, 200);
  expectAbout((noise.variance() - kBefore) / (kAfter - kBefore), 1.0 - std::exp(-1.0));
  jitter(noise, 1.0, 20000);
  expectAbout(noise.deviation(), 0.02);
}

/// A sample that could not see 0.3 ms says nothing of exact stamps.
TEST(LearnedNumbers, SlowCranksShowNoJitter) {
  const auto learns = [](double part) {
    constexpr double kOther = 1e-6;  // [rad2]
    const double speed = std::sqrt(part * kOther) / 3e-4;
    TimingNoise noise(0.0);
    for (int i = 0; i < 1000; ++i)
      noise.learn(i % 2 == 0 ? 5e-3 : -5e-3, kOther + speed * speed * noise.variance(), speed);
    return noise.variance() > 0.0;
  };
  EXPECT_FALSE(learns(0.8));
  EXPECT_TRUE(learns(1.25));
}

TEST(LearnedNumbers, TheBlowsOfTenTurns) {
  const auto add = [](BlowHistory& blows, double factor) { blows.add(factor, 0.0, ConstantErrors::Row::Zero()); };
  BlowHistory blows({1.0, 0.5, ConstantErrors::Row::Zero()});
  expectAbout(blows.prior().deviation, 0.3);
  add(blows, 0.5);  // the first guess counts for a tenth of a blow
  expectAbout((blows.prior().mean - 0.5) / 0.5, 0.1 / 1.1);
  for (int i = 0; i < 200; ++i) add(blows, 1.0);
  expectAbout(blows.prior().deviation, 0.01);
  add(blows, 0.9);
  expectAbout(1.0 - blows.prior().mean, 0.1 / 10.1);
}

/// A factor that is known to less than half the spread of blows teaches; others do not.
TEST(LearnedNumbers, ABlowThatIsHardlyKnownTeachesNothing) {
  for (const double known : {0.4, 0.6}) {
    BlowHistory blows({1.0, 0.2, ConstantErrors::Row::Zero()});
    blows.add(0.8, square(known * 0.2), ConstantErrors::Row::Zero());
    EXPECT_EQ(blows.prior().mean < 1.0, known < 0.5) << known;
  }
}

/// A wrong first guess of the inertia passes for jitter: until 60 samples have come a large innovation counts as two
/// deviations, later as three.
TEST(LearnedNumbers, TheFirstSixtySamplesShowLittleJitter) {
  constexpr double kOfStamps = 1e-6, kSpeed = 30.0, kOther = 1e-6;  // [s2], [rad/s], [rad2]
  constexpr double kTotal = kOther + kSpeed * kSpeed * kOfStamps;
  for (const int samples : {48, 75}) {
    TimingNoise noise(std::sqrt(kOfStamps));
    const double size = std::sqrt(0.5 * kTotal);
    for (int i = 1; i < samples; ++i)  // that stamps jitter shows in the first one
      noise.learn(i % 2 == 0 ? size : -size, i == 1 ? 0.99 * kTotal : kTotal, kSpeed);
    const double before = noise.variance();
    noise.learn(1.0, kTotal, kSpeed);
    const double counts = (noise.variance() - before) * kSpeed * kSpeed / kTotal * (samples + 50.0);
    expectAbout(counts, samples < 60 ? 4.0 - 1.0 : 9.0 - 1.0);
  }
}

}  // namespace
}  // namespace hammer_loads
