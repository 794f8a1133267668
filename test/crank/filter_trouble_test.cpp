// Readings that contradict the crank's filter, what it takes for the tool, and the bounds of its belief.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

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

/// A motion of the hull that no machine has leaves no state; the filter, whose tables are read at its angle, begins
/// anew.
TEST(HullShock, IsSurvivedOfAnySize) {
  HammerParameters uncertain = test::mo100LinkageParameters();
  uncertain.deviations = usualDeviations(uncertain);
  const Mechanism mechanism = test::mechanismOf(uncertain);
  for (const double acceleration : {1e9, 1e15, 1e100, 1e300, kInfinity}) {
    CrankFilter f(ShaftModel(mechanism, Level::kLinkage), 0.6, test::filterSettings(kFineCount));
    f.start({0.5, kEvenSpeed});
    double angle = 0.5;
    const auto turn = [&](int samples) {
      for (int i = 0; i < samples; ++i) f.update(1e-3, {angle += 1e-3 * kEvenSpeed, kEvenSpeed});
    };
    turn(20);
    f.setHullMotion({{}, 0.0, acceleration});
    turn(3);
    f.setHullMotion({});
    turn(50);
    EXPECT_NEAR(f.state().speed, kEvenSpeed, 1.0) << acceleration;
  }
}

/// What no torque does within a sample a rod that gives may do. What the filter allows for anyway changes nothing.
TEST_F(FilterTrouble, AKickThatARodExplainsIsFollowed) {
  constexpr double kStep = 1e-3, kKicked = 0.015;  // [s], [rad]
  CrankFilter rigid = turning(kStep);
  EXPECT_EQ(turnOn(rigid, kStep, kKicked), Tracking::kOutlier);
  CrankFilter f = turning(kStep);
  const double known = std::sqrt(f.covariance()(1, 1));
  f.inflateByRod(0.0, 4.0 * known);
  EXPECT_EQ(std::sqrt(f.covariance()(1, 1)), known);
  f.inflateByRod(0.0, kKicked / kStep);
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

using FilterAtBlow = FilterTrouble;

/// What a tool takes that is met before the dead centre is not known when the first reading shows it: up to nine tenths
/// of the speed are within two deviations, and these are no wider than that.
TEST_F(FilterAtBlow, AToolMayTakeMostOfTheSpeed) {
  double worst = 0.0;
  for (const double taken : {0.1, 0.3, 0.6, 0.9}) {
    test::StrikingCrank crank(mechanism_.linkage(), 0.737, 0.6);
    crank.blow = [&](int number) {
      const bool early = number == 6;
      return test::StrikingCrank::Blow{early ? 1.0 - taken : 0.9, true, early ? 0.03 : 0.0};
    };
    CrankFilter f = filterOf();
    f.start({crank.angle(), std::nullopt});
    for (int i = 1; i < 4000 && !(crank.blows() == 7 && f.belief().tool_met); ++i) {
      crank.advanceTo(1e-3 * i);
      f.update(1e-3, {crank.angle(), std::nullopt});
    }
    ASSERT_TRUE(f.belief().tool_met);
    const double deviation = std::sqrt(f.covariance()(CrankBelief::kFactor, CrankBelief::kFactor));
    worst = std::max(worst, std::abs(f.belief().factor - (1.0 - taken)) / deviation);
  }
  EXPECT_LT(worst, 2.0);
  EXPECT_GT(worst, 1.0);
}

/// Just before a sample it shows little there, just after one at once: without speeds, by readings in counts.
TEST_F(FilterAtBlow, KnowsTheSpeedThatAToolTookWhereverItIsMet) {
  double sum = 0.0, worst = 0.0;
  constexpr int kPlaces = 40;
  for (int place = 0; place < kPlaces; ++place) {
    test::StrikingCrank crank(mechanism_.linkage(), 0.737, 0.6);
    crank.blow = [&](int number) {
      const bool early = number == 6;
      return test::StrikingCrank::Blow{early ? 0.3 : 0.9, true, early ? 0.03 + 0.0005 * place : 0.0};
    };
    CrankFilter f = filterOf(test::kEncoderCount);
    const auto read = [&] { return test::kEncoderCount * (std::floor(crank.angle() / test::kEncoderCount) + 0.5); };
    f.start({read(), std::nullopt});
    int met = 0;
    for (int i = 1; i < 4000 && met < 6; ++i) {
      crank.advanceTo(1e-3 * i);
      f.update(1e-3, {read(), std::nullopt});
      met += crank.blows() == 7 && f.belief().struck_early;
    }
    const double error = f.belief().factor - 0.3;
    sum += error, worst = std::max(worst, std::abs(error));
  }
  EXPECT_LT(std::abs(sum / kPlaces), 0.005);
  EXPECT_LT(worst, 0.03);
}

/// What the bound takes off the factor it gives to the speed that goes with it.
TEST(BeliefBounds, ABoundFactorTakesTheSpeedAlong) {
  constexpr double kBefore = 13.0;
  CrankBelief belief;
  belief.factor = -0.3;
  belief.state = {{0, {0.3, Side::kAfterBlow}}, kBefore * belief.factor, 100.0, 0.6};
  belief.least_inertia = 1e-6, belief.most_inertia = 1e6;
  belief.covariance.diagonal() << 1e-6, 0.04, 100.0, 1e-4, 1e-4;
  belief.addNoise(CrankBelief::kSpeed, CrankBelief::kFactor, kBefore * 1e-4);
  belief.boundFactor();
  EXPECT_NEAR(belief.state.speed, kBefore * belief.factor, 1e-9);
}

}  // namespace
}  // namespace hammer_loads
