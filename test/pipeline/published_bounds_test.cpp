// What is published of cranks that are faster or heavier than any, or that were not followed before: each bound within
// a factor of 1.25 of what is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/pipeline/hull_state.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kFree = 3.0;  // [rad] from the blow: links hardly load the hull there

class ToldCrank : public testing::Test {
 protected:
  /// Of a first sample of the crank.
  std::optional<Refusal> refusalOf(double angle, double speed) const {
    return Pipeline(settings_.mechanism, settings_.pipeline).crankSample(test::kMs, {angle, speed}).refusal;
  }

  Settings settings_ = test::settingsWith("{}");
  double nominal_speed_ = kTwoPi * settings_.pipeline.turn_rate;
  double nominal_force_ =
      pulseAtConstantSpeed(settings_.mechanism, settings_.pipeline.level, nominal_speed_, {}).pulse.amplitude;
};

/// The speed alone tells degrees where there is no force.
TEST_F(ToldCrank, AFirstSampleIsNoFasterThanTwiceAWorkingMachine) {
  EXPECT_FALSE(refusalOf(kFree, 0.8 * 2.0 * nominal_speed_));
  EXPECT_EQ(refusalOf(kFree, 1.25 * 2.0 * nominal_speed_), Refusal::kImplausible);
}

/// In units of what the links make at the nominal speed, until readings and model agree and from then on. A machine
/// that turns evenly, faster and faster ones.
TEST_F(ToldCrank, ForcesAreAtMostAHalfAndThenThreeOfTheNominalOne) {
  double before = 0.0, proven = 0.0;
  for (double speed = 30.0; speed < 70.0; speed += 4.0) {
    Pipeline pipeline(settings_.mechanism, settings_.pipeline);
    for (int i = 0; i < 1500; ++i) {
      const double angle = std::remainder(1e-3 * i * speed + 0.5, kTwoPi);
      const SampleResult& result = pipeline.crankSample((i + 1) * test::kMs, {angle, speed});
      if (result.refusal) continue;
      double& most = pipeline.crank().tracker().isProven() ? proven : before;
      most = std::max(most, std::hypot(result.wrench.force_x, result.wrench.force_z) / nominal_force_);
    }
  }
  EXPECT_GT(before, 0.8 * 0.5);
  EXPECT_LT(before, 1.25 * 0.5);
  EXPECT_GT(proven, 0.8 * 3.0);
  EXPECT_LT(proven, 1.25 * 3.0);
}

/// From three tenths of the nominal speed on the hammer may have shaken the boom before.
TEST_F(ToldCrank, ABoomIsNotKnownToRestUnderAMachineAtWork) {
  const Settings on_boom = accuracy::shippedBoom("{boom: compliant, hull_motion: model}");
  const auto deviation = [&](double part) {
    Pipeline pipeline(on_boom.mechanism, on_boom.pipeline, on_boom.boom);
    pipeline.boomJoints(0, test::kFour, {0.0, -0.45, 1.0, -0.5}, {});
    const SampleResult& result = pipeline.crankSample(test::kMs, {kFree, part * 0.3 * nominal_speed_});
    return result.boom != nullptr && !result.boom->fault ? result.boom->deviations.torque[1] : 0.0;
  };
  EXPECT_GT(deviation(0.8), 0.0);
  EXPECT_GT(deviation(1.25), 5.0 * deviation(0.8));
}

/// Five samples at 200 Hz, by which the speed is known without being measured.
TEST(CrankWithoutSpeeds, IsWithheldForSomeSamplesAfterADropOut) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 4.0;
  machine.drive.start_time = 0.1, machine.drive.stop_time = 20.0;
  machine.crank.rate = 200.0, machine.crank.speed = false;
  machine.crank.drop_outs = {{3.0, 3.5}};
  const simulation::Session session = simulation::recordSession(machine);
  test::Player player(test::settingsWith("{}"), false, session);
  int withheld = 0;
  bool goes_on = false;
  player.playTo(4.0, [&](double time, const SampleResult& result) {
    goes_on = goes_on || (time > 3.5 && !result.refusal);
    withheld += time > 3.5 && !goes_on;
  });
  EXPECT_TRUE(goes_on);
  EXPECT_GE(withheld, 4);
  EXPECT_LE(withheld, 7);
}

/// A slow crank comes rarely: three readings later the last one is the hull's motion.
TEST(HullBehindASlowCrank, MovesAsTheLastReadingSays) {
  const Settings settings = test::settingsWith("hull_motion: imu\n", false);
  HullState hull(settings.mechanism.parameters(), settings.pipeline, {});
  const HullImuSettings& mounting = settings.pipeline.imu;
  StampNs stamp = 0;
  const auto read = [&](double more) {
    ImuReading reading = test::atRest(0.0, mounting);
    reading.specific_force *= 1.0 + more;
    EXPECT_FALSE(hull.imu(stamp += test::kMs, reading));
  };
  WrenchHistory step;
  step.count = 1;
  step.pieces[0].duration = 1e-3;
  for (int i = 0; i < 200; ++i) {
    read(i % 2 == 0 ? 1e-4 : -1e-4);
    hull.predict(stamp);
    hull.follow(stamp, step, {});
  }
  for (int waiting = 1; waiting <= 4; ++waiting) {
    read(0.1);
    const double more = hull.predict(stamp).gravity.z / -test::kGravity - 1.0;
    if (waiting != 3) {
      EXPECT_NEAR(more, waiting < 3 ? 0.0 : 0.1, 0.01) << waiting;
    }
  }
}

}  // namespace
}  // namespace hammer_loads
