#include "hammer_loads/crank/crank_filter.h"

#include <gtest/gtest.h>

#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/stamp.h"
#include "support/constants.h"
#include "support/filter_settings.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

class CrankFilterTest : public testing::Test {
 protected:
  CrankFilter filter(double inertia) {
    return CrankFilter(ShaftModel(mechanism_, Level::kRocker), inertia, test::filterSettings(test::kEncoderCount));
  }
  Mechanism mechanism_{test::mechanismOf(test::mo100Parameters())};
};

/// Before the work begins the weight turns the crank back onto the tool, which stops it dead: no inertia explains that.
TEST_F(CrankFilterTest, LearnsNoInertiaFromADeadStopOnTheTool) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.duration = 5.0;
    machine.drive.stop_time = 100.0;
    machine.seed = seed;
    const simulation::Session session = simulation::recordSession(machine);
    CrankFilter f = filter(1.4 * machine.drive.inertia);
    f.setHullMotion({{0.0, -machine.gravity}});
    double before_work = 0.0, stopped = 0.0;
    f.start({session.crank[0].angle, session.crank[0].speed});
    for (std::size_t i = 1; i < session.crank.size(); ++i) {
      f.update(seconds(session.crank[i].stamp - session.crank[i - 1].stamp),
               {session.crank[i].angle, session.crank[i].speed});
      if (session.truth[i].time > 1.4) continue;
      before_work = f.state().drive_inertia;
      stopped += session.truth[i].speed == 0.0;
    }
    ASSERT_GT(stopped, 100.0) << "the session must hold the stop";
    EXPECT_NEAR(before_work / machine.drive.inertia, 1.4, 0.1) << seed;
    EXPECT_NEAR(f.state().drive_inertia / machine.drive.inertia, 1.0, 0.03) << seed;
  }
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

}  // namespace
}  // namespace hammer_loads
