// What the crank's filter takes for trouble, how long it remembers that and within which bounds it stays: each within a
// factor of 1.25 of what is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

constexpr double kFineCount = kTwoPi / 65536.0, kEvenSpeed = 20.0;  // [rad], [rad/s]

void expectWithin(double value, double said) {
  EXPECT_GT(value, 0.8 * said);
  EXPECT_LT(value, 1.25 * said);
}

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

TEST_F(FilterTrouble, AFilterThatBeginsAnewFiveTimesIsLostForAWhile) {
  constexpr double kStep = 2e-5;
  CrankFilter f = turning(kStep);
  EXPECT_FALSE(f.isLost());
  const int restarts = contradict(f, kStep, 20);
  EXPECT_TRUE(f.isLost());
  EXPECT_GE(restarts, 5);
  EXPECT_LE(restarts, 7);
  // From 6 to 5 at e in 2 s.
  double time = 0.0;
  CrankFilter waits = f;
  for (; waits.isLost() && time < 5.0; time += 1e-3) waits.update(1e-3, {angle_, 0.0});
  EXPECT_GT(time, 0.25);
  EXPECT_LT(time, 0.5);
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

/// A lost one follows readings with little trust, until ten in a row say that the crank is elsewhere.
TEST_F(FilterTrouble, ALostFilterGoesWhereTenReadingsAre) {
  constexpr double kStep = 2e-5;
  CrankFilter f = turning(kStep);
  contradict(f, kStep, 20);
  ASSERT_TRUE(f.isLost());
  int samples = 0;
  do {
    turnOn(f, kStep, 0.4);
  } while (++samples < 30 && f.state().position.angle.offset < angle_ + 0.2);
  EXPECT_GE(samples, 8);
  EXPECT_LE(samples, 12);
}

/// Two contradictions that contradict each other are a new beginning, unless there were many of late.
TEST_F(FilterTrouble, SurprisesAreForgottenWithinFiftySamples) {
  constexpr double kStep = 5e-5;
  const auto afterQuiet = [&](int samples) {
    CrankFilter f = turning(kStep);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(turnOn(f, kStep, 0.3), Tracking::kOutlier);
      turnOn(f, kStep), turnOn(f, kStep);
    }
    for (int i = 0; i < samples; ++i) turnOn(f, kStep);
    EXPECT_EQ(turnOn(f, kStep, 0.3), Tracking::kOutlier);
    return turnOn(f, kStep, -0.2);
  };
  EXPECT_EQ(afterQuiet(65), Tracking::kOutlier);
  EXPECT_EQ(afterQuiet(150), Tracking::kRestarted);
}

/// After a gap the prediction is worth little; what is off by more than no machine turns is no sample of it.
TEST_F(FilterTrouble, OfAPredictionThatIsWorthNothing) {
  double said = 0.0;
  for (double gap = 0.01; gap < 0.08; gap *= 1.05) {
    CrankFilter f = filterOf();
    f.start({0.5, kEvenSpeed});
    CrankBelief there = f.belief();
    there.predict(ShaftModel(mechanism_, Level::kRocker), f.walks(), f.blowPrior(), true, f.mostSpeed(), gap);
    said = std::sqrt(there.covariance(CrankBelief::kAngle, CrankBelief::kAngle));
    if (f.update(gap, {0.5 + kEvenSpeed * gap, kEvenSpeed}) == Tracking::kRestarted) break;
  }
  expectWithin(said, 0.3);
}

TEST_F(FilterTrouble, OfAReadingThatNoWorkingMachineGives) {
  for (const double off : {0.4, 0.625}) {
    CrankFilter f = filterOf();
    f.start({0.5, kEvenSpeed});
    constexpr double kGap = 0.028;
    CrankBelief there = f.belief();
    there.predict(ShaftModel(mechanism_, Level::kRocker), f.walks(), f.blowPrior(), true, f.mostSpeed(), kGap);
    const double reading = there.state.position.angle.offset + off;
    EXPECT_EQ(f.update(kGap, {reading, kEvenSpeed}) == Tracking::kOutlier, off > 0.5) << off;
  }
}

TEST_F(FilterTrouble, WhatItLearnsStaysWithinWhatAMachineMayHave) {
  const CrankFilter f = filterOf();
  expectWithin(f.mostSpeed(), 2.0 * 300.0);
  expectWithin(f.belief().least_inertia, 0.1 * 0.6);
  expectWithin(f.belief().most_inertia, 1000.0 * 0.6);
}

/// What a sample left behind that was wrong.
TEST_F(FilterTrouble, ATorqueThatNoDriveHasIsGivenUpWithTheRest) {
  test::StrikingCrank crank(mechanism_.linkage(), 0.737, 0.6);
  crank.torque = 6000.0;
  CrankFilter f = filterOf();
  double off = 0.0, torque = 0.0;
  for (int i = 0; i < 40 && f.state().torque < 2400.0; ++i) {
    crank.advanceTo(5e-4 * i);
    const CrankSample sample{crank.angle(), crank.speed()};
    i == 0 ? f.start(sample) : static_cast<void>(f.update(5e-4, sample));
    torque = f.state().torque, off = crank.angle();
  }
  ASSERT_GT(torque, 2400.0);
  f.update(1e-4, {off + 2.0, 0.0});
  EXPECT_EQ(f.update(1e-4, {off + 2.0, 0.0}), Tracking::kRestarted);
  expectWithin(f.state().torque, 3.0 * 300.0);
}

/// At work, by measured speeds of which every other one is high by so much, and angles that a wave of 20 samples is
/// off.
class FilterAtWork : public testing::Test {
 protected:
  void run(double time, double speed_error, double angle_error = 0.0) {
    const int last = samples_ + static_cast<int>(1e3 * time);
    for (; samples_ < last; ++samples_) {
      crank_.advanceTo(1e-3 * samples_);
      const double way = samples_ % 2 == 0 ? 1.0 : -1.0, wave = std::sin(0.3 * samples_);
      const CrankSample sample{crank_.angle() + wave * angle_error, crank_.speed() + way * speed_error};
      if (samples_ == 0)
        filter_.start(sample);
      else
        tracking_ = filter_.update(1e-3, sample);
    }
  }
  double inertiaDeviation() const {
    return std::sqrt(filter_.covariance()(CrankBelief::kInertia, CrankBelief::kInertia));
  }

  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
  test::StrikingCrank crank_{mechanism_.linkage(), 0.737, 0.6};
  CrankFilter filter_{ShaftModel(mechanism_, Level::kRocker), 0.6, test::filterSettings(kFineCount)};
  int samples_{};
  Tracking tracking_{};
};

TEST_F(FilterAtWork, LearnsTheNoiseOfSpeedsWithinTwoHundredSamples) {
  run(3.0, 0.0);
  expectWithin(filter_.speedNoise(), 0.3 * 0.3);
  run(0.2, 0.6);
  const double part = (filter_.speedNoise() * filter_.speedNoise() - 0.09 * 0.09) / (0.6 * 0.6);
  expectWithin(part, 1.0 - std::exp(-1.0));
}

TEST_F(FilterAtWork, LeavesRoomToLearnTheInertiaAnew) {
  run(0.7, 0.3);  // some turns, after which a kick is no slip of the encoder yet
  EXPECT_LT(inertiaDeviation(), 0.03);
  while (crank_.crankAngle().side == Side::kBeforeBlow || crank_.crankAngle().offset < 1.0) run(1e-3, 0.3);
  crank_.advanceTo(1e-3 * samples_);
  const double kick = 0.8 * 5.0 * 1e-3;  // less than any outlier
  EXPECT_EQ(filter_.update(1e-3, {crank_.angle() + kick, std::nullopt}), Tracking::kContinued);
  expectWithin(inertiaDeviation(), 0.05);
}

/// Readings of a model that does not fit, until they are right.
TEST_F(FilterAtWork, IsUnexplainedAfterThreeTimesThreeSeconds) {
  run(3.0, 0.0);  // until speeds are known to be right
  double since = 0.0;
  for (; !filter_.isUnexplained() && since < 20.0; since += 0.05) run(0.05, 0.0, 0.01);
  EXPECT_GT(since, 5.0);
  EXPECT_LT(since, 9.0);
  double until = 0.0;
  for (; filter_.isUnexplained() && until < 40.0; until += 0.05) run(0.05, 0.0);
  EXPECT_GT(until, 5.0);
  EXPECT_LT(until, 14.0);
}

/// One that began anew of late is no judge of speeds: 1.4 s.
TEST_F(FilterAtWork, DoubtsTheInertiaAtThreeTimesTheVariance) {
  run(3.0, 0.0);
  double innovations = filter_.consistency();
  while (samples_ < 10000 && std::isfinite(filter_.consistency())) {
    innovations = filter_.consistency();
    run(1e-3, 0.0, 0.01);
  }
  expectWithin(innovations, 3.0);
}

TEST_F(FilterAtWork, JudgesNoSpeedsJustAfterABeginning) {
  run(3.0, 0.0);
  const double before = filter_.speedNoise();
  for (int i = 0; i < 2; ++i, ++samples_) {
    crank_.advanceTo(1e-3 * samples_);
    tracking_ = filter_.update(1e-3, {crank_.angle() + 1.0, std::nullopt});
  }
  ASSERT_EQ(tracking_, Tracking::kRestarted);
  double since = 0.0;
  for (; filter_.speedNoise() < 1.1 * before && since < 5.0; since += 0.01) run(0.01, 0.6);
  EXPECT_GT(since, 1.0);
  EXPECT_LT(since, 3.0);
}

/// Restitutions of 0 to 0.3 make factors of 0.64 to 1.26.
TEST_F(FilterTrouble, TheFirstGuessOfABlowHoldsAnyTool) {
  const BlowPrior first = filterOf().blowPrior();
  for (const double factor : {0.64, 1.26}) {
    EXPECT_LT(std::abs(factor - first.mean), 2.0 * first.deviation);
    EXPECT_GT(std::abs(factor - first.mean), 0.7 * first.deviation);
  }
}

}  // namespace
}  // namespace hammer_loads
