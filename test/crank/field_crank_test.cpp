// The crank filter on what a real sensor and real blows do to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "hammer_loads/crank/crank_filter.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"
#include "support/striking_crank.h"

namespace hammer_loads {
namespace {

using Blow = test::StrikingCrank::Blow;

struct Told {
  double factor{}, deviation{}, truth{};
};

struct Record {
  double rms{}, peak{}, worst{};  ///< of the crank's acceleration [rad/s2]
  double timing{}, consistency{};
  int restarts{}, outliers{}, doubtful{}, samples{}, mirrored{};
  std::vector<Told> blows;
};

struct Machine {
  std::function<Blow(int)> blow = [](int) { return Blow{}; };
  double jitter{};  ///< of stamps [s]
  double rate{1000.0};
  bool speeds{true};
  unsigned seed{1};
};

/// Eight seconds, judged from the third on. The truth is that at the stamp.
Record follow(const Machine& machine) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  test::StrikingCrank at_stamp(mechanism.linkage(), 0.737, 0.6), taken(mechanism.linkage(), 0.737, 0.6);
  at_stamp.blow = taken.blow = machine.blow;
  CrankFilter filter(ShaftModel(mechanism, Level::kRocker), 0.6, test::filterSettings());
  std::mt19937 random(machine.seed);
  std::normal_distribution<> normal;
  Record run;
  double last = 0.0, squares = 0.0;
  int judged = 0;
  bool measured = true;
  for (int i = 1; i < static_cast<int>(8.0 * machine.rate); ++i) {
    const double time = i / machine.rate;
    const double stamp = std::max(last + 1e-6, time + machine.jitter * normal(random));
    taken.advanceTo(time);
    at_stamp.advanceTo(stamp);
    CrankSample sample{std::floor(taken.angle() / test::kEncoderCount) * test::kEncoderCount, std::nullopt};
    const double speed = taken.speed() + 0.15 * normal(random);
    if (machine.speeds) sample.speed = speed;
    const Tracking tracking =
        i == 1 ? (filter.start(sample), Tracking::kRestarted) : filter.update(stamp - last, sample);
    if (tracking != Tracking::kOutlier) last = stamp;
    if (stamp < 2.0) continue;
    ++run.samples;
    run.restarts += tracking == Tracking::kRestarted;
    run.outliers += tracking == Tracking::kOutlier;
    run.doubtful += filter.isUncertain();
    run.mirrored += filter.estimate().position.isMirrored();
    if (taken.blows() > 0 && stamp < taken.blowTime() + 0.02) measured = false;
    if (!measured && stamp > taken.blowTime() + 0.06) {
      measured = true;
      const BlowFactor factor = filter.blowFactor();
      run.blows.push_back({factor.mean, factor.deviation, machine.blow(taken.blows() - 1).factor});
    }
    const double truth = at_stamp.acceleration();
    run.peak = std::max(run.peak, std::abs(truth));
    if (tracking == Tracking::kOutlier || filter.isUncertain()) continue;
    const double error = filter.estimate().acceleration - truth;
    if (std::abs(stamp - taken.blowTime()) > 5e-4) run.worst = std::max(run.worst, std::abs(error));
    squares += error * error;
    ++judged;
  }
  run.rms = std::sqrt(squares / judged);
  run.timing = filter.timingNoise();
  run.consistency = filter.consistency();
  return run;
}

TEST(FieldCrank, AllThatIsExactStaysExact) {
  const Record run = follow({});
  EXPECT_EQ(run.timing, 0.0);
  EXPECT_LT(run.rms, 0.004 * run.peak);
  EXPECT_NEAR(run.consistency, 1.0, 0.25);
  EXPECT_EQ(run.restarts, 0);
  EXPECT_EQ(run.outliers, 0);
  EXPECT_EQ(run.mirrored, 0);
  EXPECT_LT(run.doubtful, 5);
}

/// At 200 Hz without speeds a sample's prediction is as uncertain as 0.3 ms of its stamp.
TEST(FieldCrank, LearnsHowMuchTheStampsJitter) {
  const struct {
    double jitter, rate;
    bool speeds;
    double tolerance;
  } cases[] = {{1e-4, 1000.0, true, 0.15},
               {1e-4, 1000.0, false, 0.15},
               {5e-4, 1000.0, true, 0.15},
               {5e-4, 1000.0, false, 0.15},
               {1e-3, 200.0, false, 0.2}};
  for (const auto& c : cases) {
    SCOPED_TRACE(testing::Message() << c.jitter << " s, " << c.rate << " Hz, speeds " << c.speeds);
    Machine machine;
    machine.jitter = c.jitter, machine.rate = c.rate, machine.speeds = c.speeds;
    const Record run = follow(machine);
    EXPECT_NEAR(run.timing / c.jitter, 1.0, c.tolerance);
    EXPECT_EQ(run.restarts, 0);
    EXPECT_LT(run.outliers, 3);
    EXPECT_NEAR(run.consistency, 1.0, 0.25);
  }
}

/// A speed read just before the blow may bear a stamp just after it, or the reverse: it is of the other side's motion.
TEST(FieldCrank, MeasuresEachBlowsFactorThroughJitter) {
  for (const bool speeds : {true, false}) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
      Machine machine;
      machine.jitter = 2e-4;
      machine.speeds = speeds;
      machine.seed = seed;
      machine.blow = [seed](int number) {
        std::mt19937 random(1000 * seed + static_cast<unsigned>(number));
        return Blow{std::uniform_real_distribution<>(0.64, 1.26)(random), true, 0.0};
      };
      const Record run = follow(machine);
      ASSERT_GT(run.blows.size(), 20u);
      for (const Told& told : run.blows) {
        EXPECT_NEAR(told.factor, told.truth, speeds ? 0.02 : 0.03) << seed << ' ' << speeds;
        EXPECT_NEAR(told.factor, told.truth, 5.0 * told.deviation) << seed << ' ' << speeds;
      }
      EXPECT_EQ(run.restarts, 0) << seed << ' ' << speeds;
      EXPECT_EQ(run.outliers, 0) << seed << ' ' << speeds;
      EXPECT_EQ(run.mirrored, 0) << seed << ' ' << speeds;
    }
  }
}

/// What alike blows taught is no reason to take the change that a next one makes for two changes.
TEST(FieldCrank, ABlowUnlikeTheFirstOnesIsOneBlow) {
  for (const bool speeds : {true, false}) {
    for (const double last : {0.7, 1.25}) {
      Machine machine;
      machine.speeds = speeds;
      machine.blow = [last](int number) { return Blow{number < 10 ? (last < 1.0 ? 1.2 : 0.75) : last, true, 0.0}; };
      const Record run = follow(machine);
      ASSERT_GT(run.blows.size(), 20u);
      for (const Told& told : run.blows) EXPECT_NEAR(told.factor, told.truth, 0.02) << last << ' ' << speeds;
    }
  }
}

TEST(FieldCrank, ATurnWithoutContactIsFollowedOntoTheMirroredBranch) {
  for (const bool speeds : {true, false}) {
    Machine machine;
    machine.speeds = speeds;
    machine.blow = [](int number) { return Blow{1.0, number % 9 != 7, 0.0}; };
    const Record run = follow(machine);
    EXPECT_GT(run.mirrored, 200);
    EXPECT_LT(run.doubtful, run.samples / 100);
    EXPECT_EQ(run.restarts, 0);
    EXPECT_LT(run.rms, 0.03 * run.peak);
  }
}

/// The rocker's weight lets a hammer without supply come to rest just behind the dead centre.
TEST(FieldCrank, ARestAtTheDeadCentreIsNoTurnWithoutContact) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  CrankFilter filter(ShaftModel(mechanism, Level::kRocker), 0.6, test::filterSettings());
  double angle = 0.3;
  filter.start({angle, std::nullopt});
  for (int i = 0; i < 200; ++i) {
    angle = std::max(0.2 * test::kEncoderCount, angle - 0.02);
    filter.update(0.01, {std::floor(angle / test::kEncoderCount) * test::kEncoderCount, std::nullopt});
    ASSERT_FALSE(filter.isUncertain()) << i;
    ASSERT_FALSE(filter.estimate().position.isMirrored()) << i;
  }
}

}  // namespace
}  // namespace hammer_loads
