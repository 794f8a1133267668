// What is found of speeds that a filter, a scale or noise with memory has spoilt.
#include "hammer_loads/crank/speed_trust.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hammer_loads {
namespace {

/// A speed that goes up and down five times a second, as a crank's, and what a first-order filter makes of it: the
/// sinusoid's own steady answer, not a difference equation.
struct SwingingCrank {
  static constexpr double kMean = 30.0, kSwing = 18.0, kOmega = 31.0;
  static double speed(double t) { return kMean + kSwing * std::sin(kOmega * t); }
  static double acceleration(double t) { return kSwing * kOmega * std::cos(kOmega * t); }
  static double filtered(double t, double lag) {
    return kMean + kSwing / std::hypot(1.0, lag * kOmega) * std::sin(kOmega * t - std::atan(lag * kOmega));
  }
};

TEST(SpeedTrust, LearnsNothingFromAnEvenSpeedWithoutNoise) {
  for (const double wrong : {0.0, 1e-3}) {
    SpeedTrust trust;
    for (int i = 1; i < 8000; ++i) {
      trust.follow(1e-3, {30.0 + wrong, 30.0, 0.0, 0.0, 0.0, 0.0});
      if (i % 200 == 0) trust.endTurn();
    }
    EXPECT_TRUE(trust.isTrusted());
    EXPECT_EQ(trust.lag(), 0.0);
    EXPECT_NEAR(trust.scale(), wrong / 30.0, 1e-5);
    EXPECT_GT(trust.lagDeviation(), 1e-3);
    // A hundredth of the expected noise a sample, whatever is left of it.
    EXPECT_GT(trust.scaleDeviation(), 0.01 / 30.0 / std::sqrt(8000.0));
  }
}

TEST(SpeedTrust, LeavesOutNotANumber) {
  SpeedTrust trust;
  for (int i = 1; i < 8000; ++i) {
    const double t = 1e-3 * i, speed = SwingingCrank::speed(t);
    trust.follow(1e-3, {i % 100 == 0 ? NAN : speed + 0.1 * std::sin(7e3 * t), speed, SwingingCrank::acceleration(t)});
    if (i % 200 == 0) trust.endTurn();
  }
  EXPECT_TRUE(trust.areGood());
  EXPECT_NEAR(trust.lag(), 0.0, 1e-4);
}

/// An estimate that takes up half of what a late speed says, and knows what its lag makes of it.
TEST(SpeedTrust, JudgesSpeedsByAnEstimateThatUsedThem) {
  constexpr double kLag = 2e-3, kTaken = 0.5;
  SpeedTrust trust;
  const int turn = static_cast<int>(1e3 * 2.0 * M_PI / SwingingCrank::kOmega);
  for (int i = 1; i < 40 * turn; ++i) {
    const double t = 1e-3 * i, measured = SwingingCrank::filtered(t, kLag);
    const double pulled = SwingingCrank::speed(t) + kTaken * (measured - SwingingCrank::speed(t));
    trust.follow(1e-3, {measured, pulled, SwingingCrank::acceleration(t), -kTaken * SwingingCrank::acceleration(t),
                        kTaken * SwingingCrank::speed(t), 0.0});
    if (i % turn == 0) trust.endTurn();
  }
  EXPECT_TRUE(trust.lags());
  EXPECT_NEAR(trust.lag(), kLag, 0.05 * kLag);
  EXPECT_NEAR(trust.scale(), 0.0, 1e-3);
}

TEST(SpeedTrust, IsSilentBeforeItKnows) {
  SpeedTrust trust;
  for (int i = 1; i <= 100; ++i) trust.follow(1e-3, {40.0, 30.0, 100.0, 0.0, 0.0, 0.0});
  trust.endTurn();
  EXPECT_FALSE(trust.knows() || trust.lags() || trust.isOutOfScale());
}

}  // namespace
}  // namespace hammer_loads
