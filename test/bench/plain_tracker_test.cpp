#include "hammer_loads/bench/plain_tracker.h"

#include <gtest/gtest.h>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/mo100.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kCount = kTwoPi / 4096.0;

TEST(PlainTracker, TakesSpeedsAndTheirDifferenceAsTheyAre) {
  PlainTracker tracker(PlainTracker::Acceleration::kDifference, kCount, 0.6, {});
  tracker.start({6.2, 30.0});
  EXPECT_EQ(tracker.update(1e-2, {6.2 + 0.305 - kTwoPi, 31.0}), Tracking::kContinued);
  EXPECT_DOUBLE_EQ(tracker.estimate().speed, 31.0);
  EXPECT_NEAR(tracker.estimate().acceleration, 100.0, 1e-9);
  EXPECT_EQ(tracker.estimate().position.blowsPassed(), 0);  // -1 before
  EXPECT_NEAR(tracker.between(5e-3).speed, 30.5, 1e-9);
}

TEST(PlainTracker, AssumesNoAccelerationAsThePaper) {
  PlainTracker tracker(PlainTracker::Acceleration::kZero, kCount, 0.6, {});
  tracker.start({1.0, std::nullopt});
  EXPECT_FALSE(tracker.hasSpeed());
  tracker.update(1e-2, {1.3, std::nullopt});
  EXPECT_NEAR(tracker.estimate().speed, 30.0, 0.1);
  EXPECT_EQ(tracker.estimate().acceleration, 0.0);
}

TEST(PlainTracker, ThePapersAssumptionOfConstantSpeedIsThirtyPercentWrong) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.crank.counts = 4096;
  machine.duration = 12.0;
  const simulation::Session session = simulation::recordSession(machine);
  const auto errorsWith = [&](PlainTracker::Acceleration acceleration) {
    PipelineSettings settings = loadFiles(configDirectory(), {}).value->pipeline;
    settings.crank_angle_resolution = kCount;
    return judge(runSession(session, machine.start_stamp, test::mechanismOf(machine.hammer), settings,
                            plainTracker(acceleration)),
                 session, machine);
  };
  EXPECT_GT(errorsWith(PlainTracker::Acceleration::kZero).turn_peak, 0.25);
  EXPECT_GT(errorsWith(PlainTracker::Acceleration::kDifference).rms_z, 0.03);
}

}  // namespace
}  // namespace hammer_loads::accuracy
