// Readings that contradict the crank's filter.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "support/filter_settings.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kFineCount = kTwoPi / 65536.0, kEvenSpeed = 20.0;  // [rad], [rad/s]

class FilterTrouble : public testing::Test {
 protected:
  CrankFilter filterOf(double count = kFineCount) const {
    return CrankFilter(ShaftModel(mechanism_, Level::kRocker), 0.6, test::filterSettings(count));
  }
  /// A crank that turns evenly, fast enough in its steps of `dt` that it stays on one side of the blow.
  Tracking turnOn(CrankFilter& f, double dt, double off = 0.0) {
    angle_ += kEvenSpeed * dt;
    return f.update(dt, {angle_ + off, kEvenSpeed});
  }
  CrankFilter turning(double dt) {
    CrankFilter f = filterOf();
    angle_ = 0.5;
    f.start({angle_, kEvenSpeed});
    for (int i = 0; i < 50; ++i) turnOn(f, dt);
    return f;
  }
  /// Nothing but readings that contradict each other: how often the filter begins anew.
  int contradict(CrankFilter& f, double dt, int most) {
    int restarts = 0;
    for (int i = 0; i < 100 * most && restarts < most && !f.isLost(); ++i)
      restarts += turnOn(f, dt, i / 2 % 2 == 0 ? 0.0 : 0.4) == Tracking::kRestarted && !f.hasSpeed();
    return restarts;
  }

  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
  double angle_{};
};

/// By two stamps of a hull's unit that were one nanosecond apart; the speeds' noise that it left made every later
/// sample a beginning.
TEST_F(FilterTrouble, AShockOfTheHullDoesNotMakeEverySampleABeginning) {
  for (const int before : {2, 5, 20}) {
    CrankFilter f = filterOf(kTwoPi / 4096.0);
    angle_ = 1.0;
    f.start({angle_, 0.0});
    const auto rest = [&](int samples) {
      int beginnings = 0;
      for (int i = 0; i < samples; ++i) beginnings += f.update(1e-3, {angle_, 0.05 * (i % 2)}) == Tracking::kRestarted;
      return beginnings;
    };
    rest(before);
    f.setHullMotion({{}, 0.0, 6e6});
    rest(2);
    f.setHullMotion({});
    rest(10);
    EXPECT_EQ(rest(100), 0) << before;
    EXPECT_LT(std::abs(f.state().speed), 1.0) << before;
  }
}

/// What no torque does within a sample a rod that gives may do. What the filter allows for anyway changes nothing.
TEST_F(FilterTrouble, AKickThatARodExplainsIsFollowed) {
  constexpr double kStep = 1e-3, kKicked = 0.015;  // [s], [rad]
  CrankFilter rigid = turning(kStep);
  EXPECT_EQ(turnOn(rigid, kStep, kKicked), Tracking::kOutlier);
  CrankFilter f = turning(kStep);
  const double known = std::sqrt(f.covariance()(1, 1));
  f.considerRod(0.0, 4.0 * known);
  EXPECT_EQ(std::sqrt(f.covariance()(1, 1)), known);
  f.considerRod(0.0, kKicked / kStep);
  EXPECT_EQ(turnOn(f, kStep, kKicked), Tracking::kContinued);
  EXPECT_NEAR(f.state().position.angle.offset, angle_ + kKicked, 0.2 * kKicked);
}

/// One outlier does not move a lost filter; readings in a row that agree do, and end its being lost.
TEST_F(FilterTrouble, ALostFilterFollowsReadingsThatAgree) {
  constexpr double kStep = 2e-5;
  CrankFilter f = turning(kStep);
  contradict(f, kStep, 20);
  ASSERT_TRUE(f.isLost());
  int samples = 0;
  do {
    turnOn(f, kStep, 0.4);
  } while (++samples < 30 && f.state().position.angle.offset < angle_ + 0.2);
  EXPECT_GT(samples, 1);
  EXPECT_LT(samples, 30);
  for (int i = 0; f.isLost() && i < 5000; ++i) f.update(1e-3, {angle_ + 0.4, 0.0});
  EXPECT_FALSE(f.isLost());
}

}  // namespace
}  // namespace hammer_loads
