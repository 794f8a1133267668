// How long followers of sensors remember, what they doubt and when they give up: each within a factor of 1.25 of what
// is said.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/pipeline/driven_signal.h"
#include "hammer_loads/pipeline/hull_motion_filter.h"
#include "hammer_loads/pipeline/pressure_trust.h"
#include "hammer_loads/pipeline/unit_check.h"
#include "hammer_loads/pipeline/vibration_bound.h"
#include "hammer_loads/util/square.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kShort = 0.8, kLong = 1.25, kFollowStep = 1e-3;

void expectRoughly(double value, double said) {
  EXPECT_GT(value, kShort * said);
  EXPECT_LT(value, kLong * said);
}

TEST(FollowerNumbers, PressuresThatWereLateAreTriedAgainAfterAMinute) {
  PressureTrust trust;
  for (int i = 0; i < 200; ++i) trust.followDelay(0.02, 100.0, kFollowStep);
  EXPECT_TRUE(trust.isLate());
  double time = 0.0;
  for (; trust.isLate() && time < 200.0; time += 0.1) trust.followDelay(0.0, 0.0, 0.1);
  expectRoughly(time, 60.0);
}

/// A crank without measured speeds that turns so fast; every other step by `uneven` faster. No crank is faster than 20.
class Turning {
 public:
  UnitCheck check{20.0};
  void run(double time, double rate, double uneven = 0.0) {
    for (int i = 0; i < std::lround(time / kFollowStep); ++i)
      check.add(kFollowStep, angle_ += kFollowStep * rate * (i % 2 == 0 ? 1.0 : 1.0 + uneven), std::nullopt);
  }

 private:
  double angle_{};
};

/// Each faster than any crank, but not so in degrees.
TEST(FollowerNumbers, StepsOfDegreesRepeatThemselves) {
  for (const double uneven : {0.8 * 0.2, 1.3 * 0.2}) {
    Turning crank;
    crank.run(2.0, 400.0, uneven);
    EXPECT_EQ(crank.check.looksWrong(), uneven < 0.2) << uneven;
  }
}

TEST(FollowerNumbers, TwoVotesForAnotherUnitAreSuspicious) {
  Turning crank;
  int samples = 0;
  for (; samples < 20 && !crank.check.suspects(); ++samples) crank.run(kFollowStep, 400.0);
  EXPECT_EQ(samples, 4);  // the first is a beginning, the second has none before it
}

TEST(FollowerNumbers, AUnitIsRightAgainAfterTwoSecondsOfMotion) {
  for (const double rate : {0.8, 1.25}) {  // a slower one says nothing
    Turning crank;
    crank.run(2.0, 400.0);
    ASSERT_TRUE(crank.check.looksWrong());
    double time = 0.0;
    for (; crank.check.looksWrong() && time < 10.0; time += 0.01) crank.run(0.01, rate);
    if (rate > 1.0)
      expectRoughly(time, 2.0);
    else
      EXPECT_GE(time, 10.0);
  }
}

/// Eight votes, each of a radian by an angle in degrees, of a speed that is hardly more than its noise.
TEST(FollowerNumbers, AHundredthOfARadianIsEnoughOfTheOtherUnit) {
  UnitCheck check(2000.0);
  double angle = 0.0;
  for (; angle < 50.0 && !check.looksWrong(); angle += kFollowStep * 10.0) check.add(kFollowStep, angle, 10.0 / 70.0);
  expectRoughly(angle, 8.0);
}

class VibratingBoom : public testing::Test {
 protected:
  Settings settings_ = accuracy::shippedBoom("{}");
  Boom boom_ = *settings_.boom;
};

TEST_F(VibratingBoom, AMotionThatNothingDampsIsOverAfterTenSeconds) {
  EXPECT_FALSE(boom_.vibration().known());
  expectRoughly(VibrationBound::decayTime(boom_.vibration()), 10.0);
}

/// Twice what all joints have at 1 rad/s.
TEST_F(VibratingBoom, NoOperatorSwingsItFasterThanARadianASecond) {
  JointMotion motion;
  motion.position = motion.velocity = motion.acceleration = JointVector::Zero(boom_.chain().joints());
  motion.position[1] = -0.45, motion.position[2] = 1.0, motion.position[3] = -0.5;
  boom_.moveCompliant(motion, {0.0, 0.0, -9.80665});
  VibrationBound bound;
  const JointMatrix& mass = boom_.vibration().modes().mass;
  JointVector rate = JointVector::Constant(mass.rows(), 0.02);
  const double energy_of_one = 0.5 * JointVector::Ones(mass.rows()).dot(mass * JointVector::Ones(mass.rows()));
  while (bound.holds(boom_.vibration())) boom_.vibration().strike(mass * rate);
  expectRoughly(std::sqrt(boom_.vibration().energy() / energy_of_one), 2.0);
}

/// A hull that does not move, by readings with noise, and a load that jumps about.
class QuietSignal {
 public:
  DrivenSignal signal{{DrivenSignal::Reads::kItself, 0.1, {5e-3, 5e-3, 5e-2}, {4e3, 4e3, 2e3}, {10.0, 10.0, 5.0}}};
  void run(int readings, double noise, double compliance = 0.0, bool works = true) {
    for (int i = 0; i < readings; ++i) {
      signal.advance({kFollowStep, kFollowStep * load_, none_, none_, none_});
      load_ = Eigen::Vector3d(0.0, 1000.0 * normal_(random_), 0.0);
      signal.read(noise * normal_(random_) + compliance * load_[1], kFollowStep, load_, {}, works);
    }
  }
  double deviation() const { return std::sqrt(DrivenSignal::Future(signal).at(none_).signal_variance); }

 private:
  std::mt19937_64 random_{3};
  std::normal_distribution<> normal_;
  Eigen::Vector3d none_ = Eigen::Vector3d::Zero(), load_ = none_;
};

/// A hull that shakes faster than it is read: what its readings miss at work is its own but for their noise at rest,
/// or, where no rest was seen, for three times that of a usual unit.
TEST(FollowerNumbers, WhatReadingsMissAtWorkIsMotionBeyondTheirNoise) {
  const auto after = [](double at_rest, double at_work) {
    QuietSignal quiet;
    if (at_rest > 0.0) quiet.run(8000, at_rest, 0.0, false);
    quiet.run(8000, at_work);
    return quiet.deviation();
  };
  for (const double noise : {0.8 * 0.3, 0.3}) EXPECT_LT(after(0.0, noise), 0.5 * noise) << "smoothed";
  expectRoughly(after(0.0, 1.5 * 0.3), std::sqrt(square(1.5) - 1.0) * 0.3);
  expectRoughly(after(0.15, 0.3), std::sqrt(square(0.3) - square(0.15)));
  EXPECT_LT(after(0.3, 0.3), 0.6 * 0.3);
}

TEST(FollowerNumbers, ASignalsNoiseIsThatOfAThousandReadings) {
  QuietSignal quiet;
  quiet.run(8000, 0.1);
  const double before = square(quiet.signal.noise());
  expectRoughly(quiet.signal.noise(), 0.1);
  quiet.run(500, 0.14);
  expectRoughly((square(quiet.signal.noise()) - before) / (square(0.14) - square(0.1)), 1.0 - std::exp(-0.5));
}

/// The first reading that is foretold, and is far off, counts as nine times the variance: a tenth of it shows.
TEST(FollowerNumbers, ASignalsFirstNoiseStandsForTenReadings) {
  QuietSignal quiet;
  quiet.run(1, 0.1);
  quiet.run(1, 1e6);
  expectRoughly(square(quiet.signal.noise() / 0.1), 1.0 + (9.0 - 1.0) / 10.0);
}

TEST(FollowerNumbers, ASignalsComplianceWandersAsThePoseChanges) {
  QuietSignal quiet;
  quiet.run(4000, 0.1, 2e-3);
  EXPECT_NEAR(quiet.signal.compliance()[1], 2e-3, 1e-4);
  const double before = square(quiet.signal.complianceDeviation()[1]);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  for (int i = 0; i < 100; ++i) quiet.signal.advance({1.0, none, none, none, none});
  expectRoughly(std::sqrt((square(quiet.signal.complianceDeviation()[1]) - before) / 100.0), 0.01 * 5e-3);
}

/// Its impulse is known when the crank has turned on.
TEST(FollowerNumbers, ABlowsImpulseIsDoubtedByAThird) {
  QuietSignal quiet;
  quiet.run(4000, 0.1, 2e-3);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero(), impulse(0.0, 50.0, 0.0);
  const auto varianceAfter = [&](const Eigen::Vector3d& blow) {
    DrivenSignal::Future future(quiet.signal);
    future.advance({1e-6, impulse, blow, none, none});
    return future.at(none).integral_variance;
  };
  expectRoughly(std::sqrt(varianceAfter(impulse) - varianceAfter(none)), 0.3 * 50.0 * 2e-3);
}

/// The weight's part of a signal is its mean: of a turn at first.
TEST(FollowerNumbers, ASignalsWeightIsItsMeanFromTheFirstTurnOn) {
  DrivenSignal signal({DrivenSignal::Reads::kItself, 0.1, {5e-3, 5e-3, 5e-2}, {4e3, 4e3, 2e3}, {10.0, 10.0, 5.0}});
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  for (int i = 0; i <= 200; ++i) {
    if (i > 0) signal.advance({kFollowStep, none, none, none, none});
    signal.read(i == 0 ? 1.0 : 0.0, kFollowStep, none, {}, false);
  }
  expectRoughly(-signal.swing(1e-6, none, none).velocity / 1e-6, 0.5);  // 0.2 s / (0.2 s + 0.2 s)
}

/// A hull that stands still on an IMU with noise, under a load that jumps about.
class StillHull {
 public:
  HullMotionFilter filter{[] {
                            HullImuSettings imu;
                            imu.max_age = 0.1;
                            return imu;
                          }(),
                          test::mo100Parameters()};
  /// load: greatest in each sample [N]; noise: of forces [m/s2], a 30th of it of the rate [rad/s].
  KnownHullMotion after(int samples, double load, double noise) {
    for (int i = 0; i < samples; ++i) {
      stamp_ += 1000000;
      filter.add({stamp_,
                  {{noise * normal_(random_), 0.0, 9.8 + noise * normal_(random_)},
                   {0.0, noise / 30.0 * normal_(random_), 0.0}}});
      const double to = load * std::cos(0.7 * ++count_);
      WrenchHistory step;
      step.count = 1;
      step.pieces[0] = {1e-3, {0.0, last_, 0.0}, {0.0, to, 0.0}, {0.0, 0.5 * (last_ + to), 0.0}, false, {}};
      last_ = to;
      filter.follow(stamp_, step, {});
    }
    return filter.at(stamp_).value_or(KnownHullMotion{});
  }
  /// Under a load that grows from nothing to this within a sample, of which no reading has come [N].
  KnownHullMotion pushed(double load) {
    WrenchHistory step;
    step.count = 1;
    step.pieces[0] = {1e-3, {0.0, 0.0, 0.0}, {0.0, load, 0.0}, {0.0, 0.5 * load, 0.0}, false, {}};
    filter.follow(stamp_ += 1000000, step, {});
    return filter.at(stamp_).value_or(KnownHullMotion{});
  }

 private:
  StampNs stamp_{1000000000};
  std::mt19937_64 random_{7};
  std::normal_distribution<> normal_;
  double last_{};
  int count_{};
};

/// It is five times as heavy as its rocker at least: so far may a first load move it.
TEST(FollowerNumbers, AHullIsNoLighterThanFiveRockers) {
  StillHull hull;
  hull.after(20, 0.0, 1e-4);
  const double load = 1e5, moved = std::sqrt(hull.pushed(load).covariance(1, 1));
  expectRoughly(moved, load / (5.0 * test::mo100Parameters().rocker_mass));
}

/// What such a unit adds to all its readings alike.
TEST(FollowerNumbers, AnImusOffsetsAreInTheHullsMotion) {
  StillHull hull;
  const KnownHullMotion known = hull.after(8000, 1000.0, 1e-4);
  expectRoughly(std::sqrt(known.covariance(1, 1)), 0.05);
  expectRoughly(std::sqrt(known.covariance(2, 2)), 0.005);
}

/// A usual unit's, until the hammer has worked; at rest the readings show noise alone.
TEST(FollowerNumbers, AnImusNoiseIsLearnedAtWork) {
  constexpr double kSmoothed = 0.27;  // of one reading's noise, by those before it
  for (const double part : {0.8, 1.25}) {
    StillHull hull;
    hull.after(20, 1e5, 0.01);
    const KnownHullMotion rest = hull.after(6000, part * 0.05 * 1e5, 0.01);
    const double force = std::sqrt(rest.covariance(1, 1) - square(0.05)),
                 rate = std::sqrt(rest.covariance(2, 2) - square(0.005));
    if (part < 1.0) {
      expectRoughly(force, kSmoothed * 0.1);
      expectRoughly(rate, kSmoothed * 0.003 * 1.2);
    } else {
      EXPECT_LT(force, kSmoothed * 0.03);
      EXPECT_LT(rate, kSmoothed * 0.001);
    }
  }
}

}  // namespace
}  // namespace hammer_loads
