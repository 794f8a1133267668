#include "hammer_loads/crank/crank_filter.h"

#include <gtest/gtest.h>

#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

simulation::Session shortSession(bool speed, double rate, double true_inertia, std::uint64_t seed = 5) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 6.0;
  machine.drive.stop_time = 100.0;
  machine.drive.inertia = true_inertia;
  machine.crank.rate = rate;
  machine.crank.speed = speed;
  machine.seed = seed;
  machine.gravity = 0.0;
  return simulation::recordSession(machine);
}

class CrankFilterTest : public testing::Test {
 protected:
  CrankFilter filter(double inertia) {
    return CrankFilter(ShaftModel(mechanism_, Level::kRocker), inertia, test::filterSettings(test::kEncoderCount));
  }
  /// Runs a session and calls check(filter, truth) after each sample.
  template <typename Check>
  void run(CrankFilter& f, const simulation::Session& session, Check check) {
    for (std::size_t i = 0; i < session.crank.size(); ++i) {
      const CrankSample sample{session.crank[i].angle, session.crank[i].speed};
      if (i == 0) {
        f.start(sample);
      } else {
        f.update(1e-9 * static_cast<double>(session.crank[i].stamp - session.crank[i - 1].stamp), sample);
      }
      check(f, session.truth[i]);
    }
  }
  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
};

TEST_F(CrankFilterTest, IdentifiesTheInertiaFromAGuessFiftyPercentWrong) {
  for (const double guess : {0.3, 0.9}) {
    for (const bool speed : {true, false}) {
      CrankFilter f = filter(guess);
      run(f, shortSession(speed, 1000.0, 0.6), [](const CrankFilter&, const simulation::CrankTruth&) {});
      EXPECT_NEAR(f.state().drive_inertia, 0.6, 0.012) << guess << ' ' << speed;
    }
  }
}

/// Before the work begins the weight turns the crank back onto the tool, which stops it dead: no inertia explains that.
TEST_F(CrankFilterTest, LearnsNoInertiaFromADeadStopOnTheTool) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.duration = 5.0;
    machine.drive.stop_time = 100.0;
    machine.seed = seed;
    const simulation::Session session = simulation::recordSession(machine);
    CrankFilter f = filter(1.4 * machine.drive.inertia);
    f.setHullMotion({{0.0, -machine.gravity}});
    double before_work = 0.0, stopped = 0.0;
    run(f, session, [&](const CrankFilter& at, const simulation::CrankTruth& truth) {
      if (truth.time > 1.4) return;
      before_work = at.state().drive_inertia;
      stopped += truth.speed == 0.0;
    });
    ASSERT_GT(stopped, 100.0) << "the session must hold the stop";
    EXPECT_NEAR(before_work / machine.drive.inertia, 1.4, 0.1) << seed;
    EXPECT_NEAR(f.state().drive_inertia / machine.drive.inertia, 1.0, 0.03) << seed;
  }
}

TEST_F(CrankFilterTest, GivesTheMotionBetweenSamples) {
  simulation::Session dense = shortSession(true, 2000.0, 0.6);
  CrankFilter f = filter(0.6);
  double worst = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < dense.crank.size(); i += 20) {  // 100 Hz out of 2 kHz
    const CrankSample sample{dense.crank[i].angle, dense.crank[i].speed};
    const auto seconds = [&](std::size_t k) {
      return 1e-9 * static_cast<double>(dense.crank[k].stamp - dense.crank[last].stamp);
    };
    if (i == 0) {
      f.start(sample);
      continue;
    }
    f.update(seconds(i), sample);
    for (std::size_t k = last; k <= i && dense.truth[i].time > 3.0; ++k) {
      const CrankEstimate e = f.between(seconds(k));
      worst = std::max(worst, std::abs(CrankAngle::wrapToPi(e.position.angle.offset - dense.truth[k].angle)));
      EXPECT_NEAR(e.speed, dense.truth[k].speed, 1.0) << dense.truth[k].time;
    }
    EXPECT_EQ(f.between(seconds(i)).acceleration, f.estimate().acceleration);
    last = i;
  }
  EXPECT_LT(worst, 4e-3);
  EXPECT_GT(f.uncertaintyBetween(0.005, 1.0).own(0, 0), 0.0);
}

TEST_F(CrankFilterTest, IgnoresOneOutlierAndAcceptsTwo) {
  CrankFilter f = filter(0.6);
  f.start({0.5, 20.0});
  double angle = 0.5;
  for (int i = 0; i < 50; ++i) EXPECT_EQ(f.update(1e-3, {angle += 0.02, 20.0}), Tracking::kContinued);
  EXPECT_EQ(f.update(1e-3, {angle + 2.0, 20.0}), Tracking::kOutlier);
  EXPECT_EQ(f.update(2e-3, {angle += 0.04, 20.0}), Tracking::kContinued);
  EXPECT_EQ(f.update(1e-3, {angle + 2.02, 20.0}), Tracking::kOutlier);
  EXPECT_EQ(f.update(2e-3, {angle + 2.04, 20.0}), Tracking::kRestarted);
  EXPECT_NEAR(CrankAngle::wrapToPi(f.estimate().position.angle.offset - (angle + 2.04)), 0.0, test::kEncoderCount);
}

TEST_F(CrankFilterTest, TheEncoderDecidesTheSideOfTheBlow) {
  CrankFilter f = filter(0.6);
  f.start({kTwoPi - 40 * test::kEncoderCount, 15.0});
  for (int count = -39; count <= 10; ++count) {
    const double reading = count < 0 ? kTwoPi + count * test::kEncoderCount : count * test::kEncoderCount;
    f.update(test::kEncoderCount / 15.0, {reading, 15.0});
    const Side side = f.estimate().position.angle.side;
    EXPECT_EQ(side, count < 0 ? Side::kBeforeBlow : Side::kAfterBlow) << count;
  }
}

TEST_F(CrankFilterTest, StaysSoundWhateverComes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  for (int round = 0; round < 50; ++round) {
    CrankFilter f = filter(0.6);
    f.start({any(random) * 10, any(random) * 100});
    for (int i = 0; i < 500; ++i) {
      f.update(std::pow(10.0, -5 + 4 * std::abs(any(random))), {any(random) * 1e4, any(random) * 300});
      ASSERT_TRUE(std::isfinite(f.estimate().acceleration));
      ASSERT_TRUE(f.covariance().allFinite());
      ASSERT_GT(f.state().drive_inertia, 0.0);
    }
  }
}

TEST(Encoder, MeansTheMiddleOfACount) {
  Encoder encoder(test::kEncoderCount);
  EXPECT_DOUBLE_EQ(encoder.angle(100 * test::kEncoderCount), 100.5 * test::kEncoderCount);
  EXPECT_FALSE(encoder.isFiner());
}

TEST(Encoder, TakesAFinerSensorAsItIs) {
  Encoder encoder(test::kEncoderCount);
  for (int i = 0; i < 5; ++i) encoder.angle(0.1234 * i + 0.01);
  EXPECT_TRUE(encoder.isFiner());
  EXPECT_DOUBLE_EQ(encoder.angle(100 * test::kEncoderCount), 100 * test::kEncoderCount);
}

}  // namespace
}  // namespace hammer_loads
