// Boom loads while sensors or crank are silent, and afterwards. They are close to the truth, or their deviation states
// the possible error.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipeline/disturbed_session.h"

namespace hammer_loads::test {
namespace {

/// Records a session without crank readings in an interval [s], during which the hammer continues to work.
Session withGap(double from, double to) {
  simulation::MachineSettings m = disturbedMachine();
  m.crank.drop_outs = {{from, to}};
  return simulation::recordSession(m);
}

TEST(GapOfTheCrank, TheBoomMaySwingInAWayNotKnown) {
  const BoomErrors e = errorsOf(withGap(kDisturbed, kGoesOn), kBoomGiven, {}, kGoesOn, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
  EXPECT_GT(e.sectionsCovered(), 0.85);
}

TEST(GapOfTheCrank, ANodeThatIsStartedInMidWorkKnowsThatItDoesNotKnow) {
  const BoomErrors e = errorsOf(withGap(0.0, kGoesOn), kBoomGiven, {}, kGoesOn, 7.2);
  EXPECT_GT(e.worstTorque(), 0.4) << "what the deviations must say";
  EXPECT_GT(e.covered(), 0.85);
}

TEST(GapOfTheCrank, SensorsFindTheVibrationAtOnce) {
  const Session session = withGap(kDisturbed, kGoesOn);
  for (const bool by_pressures : {false, true}) {
    const BoomErrors e =
        errorsOf(session, by_pressures ? kBoomIdentified : kHullByImu, {!by_pressures, by_pressures}, kGoesOn, 7.2);
    EXPECT_LT(e.worstTorque(), 0.05) << by_pressures;
    EXPECT_LT(e.worstSection(), 0.04) << by_pressures;
    EXPECT_GT(e.covered(), 0.85) << by_pressures;
  }
}

/// The pressures stop for a second. The torques continue from the last reading, which becomes less and less valid.
TEST(PressuresThatStop, AreAnErrorThatGrowsUntilTheyAreBack) {
  for (const bool rock : {false, true}) {
    Session session = simulation::recordSession(disturbedMachine(rock));
    silence(session.pressures, kDisturbed, 6.0);
    const auto within = [&](double from, double to) {
      return errorsOf(session, kBoomIdentified, {false, true}, from, to);
    };
    EXPECT_GT(within(4.0, kDisturbed).covered(), 0.85) << rock;
    const BoomErrors overdue = within(kDisturbed, 5.2), back = within(6.0, 6.2);
    EXPECT_GT(overdue.worstTorque(), 0.1) << rock << ": what there is to say";
    // A known limit: on rock, through the bucket linkage, the error grows faster than its deviation.
    EXPECT_GT(overdue.covered(), rock ? 0.6 : 0.85) << rock;
    EXPECT_GT(overdue.sectionsCovered(), rock ? 0.6 : 0.85) << rock;
    EXPECT_GT(back.covered(), 0.85) << rock;
    EXPECT_LT(back.worstTorque(), 0.1) << rock;
  }
}

/// Frequencies and damping identified by the IMU remain in use without it, and move the hull under the hammer.
TEST(ImuThatStops, LeavesTheHullsMotionToTheModel) {
  Session session = simulation::recordSession(disturbedMachine());
  silence(session.imu, kDisturbed, 6.0);
  const BoomErrors fixed = errorsOf(session, "{boom: compliant, hull_motion: fixed}", {}, kDisturbed, 6.0);
  EXPECT_GT(fixed.force_z.worstOfLargest(), 0.08) << "what the hull's motion is worth";
  const BoomErrors e = errorsOf(session, kHullByImu, {true, false}, kDisturbed, 6.0);
  EXPECT_EQ(e.refused, 0U);
  EXPECT_LT(e.force_z.worstOfLargest(), 0.04);
  EXPECT_LT(std::abs(e.energy()), 0.02);
  EXPECT_LT(e.worstTorque(), 0.04);
  EXPECT_GT(e.covered(), 0.85);
}

/// Without a model of the boom, the last motion that the IMU showed soon becomes invalid.
TEST(ImuThatStops, IsForgottenWithoutAJump) {
  simulation::MachineSettings m = accuracy::machineOnBoom(7.0);
  m.drive.start_time = 0.1;
  Session session = simulation::recordSession(m);
  auto& all = session.imu;
  const std::int64_t first = all.front().stamp, period = 310'000'000, silent = 60'000'000;
  all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& r) { return (r.stamp - first) % period < silent; }),
            all.end());
  const char* keys = "{boom: rigid, hull_motion: imu}";
  const BoomErrors e = errorsOf(session, keys, {true, false}, 3.0, 6.9);
  EXPECT_LT(e.force_z.worstOfLargest(), 0.15);
  EXPECT_LT(e.force_z.rms(), 0.06);
  EXPECT_EQ(e.refused, 0U);
}

/// Few readings determine the deviation of a measured torque as well as many.
TEST(PressuresThatBegin, HaveATrueDeviationAtOnce) {
  simulation::MachineSettings m = disturbedMachine();
  m.on_boom.pressures.rate = 100.0;
  const Session session = simulation::recordSession(m);
  EXPECT_GT(errorsOf(session, kBoomIdentified, {false, true}, 0.1, 0.6).covered(), 0.9);
}

/// An interval without crank readings gives no information on the deviation of a measured torque.
TEST(GapOfTheCrank, LeavesTheDeviationOfMeasuredTorquesAsItWas) {
  const Session session = withGap(kDisturbed, kGoesOn);
  const Settings settings = accuracy::shippedBoom(kBoomIdentified);
  Player player(settings, true, session);
  player.imu_speaks = false;
  double before = 0.0, after = 0.0;
  player.playTo(7.2, [&](double time, const SampleResult& r) {
    if (r.refusal || !r.boom || r.boom->fault) return;
    double& worst = time < kDisturbed ? before : after;
    if (time > 4.0) worst = std::max(worst, r.boom->deviations.torque[1]);
  });
  EXPECT_GT(before, 0.0);
  EXPECT_LT(after, 1.5 * before);
}

}  // namespace
}  // namespace hammer_loads::test
