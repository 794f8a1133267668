// Compares the misuse counted from measurements with that of the simulated machine.
#include <gtest/gtest.h>

#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using Counts = MisuseCounts;

Counts misuseOf(const simulation::Session& session, const Settings& settings, bool with_boom, bool pressures = true) {
  test::Player player(settings, with_boom, session);
  player.imu_speaks = false;
  player.pressures_speak = pressures;
  player.playTo(1e9, [](double, const SampleResult&) {});
  player.pipeline.end();
  return player.pipeline.counts().misuse;
}

simulation::Session atWork(double blank_share) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = machine.drive.stop_time = 20.0;
  machine.blow.blank_share = blank_share;
  return simulation::recordSession(machine);
}

/// Returns the number of blank firings by the true angle: the crank passes two dead centres for each.
double blankFiringsOf(const simulation::Session& session) {
  return 0.5 * static_cast<double>(session.truth.back().turn - static_cast<std::int64_t>(session.blows.size()));
}

TEST(Misuse, CountsTheBlankFiringsOfTheMachine) {
  const Settings settings = test::settingsWith("level: rocker\n", false);
  const simulation::Session good = atWork(0.0), some = atWork(0.1);
  const Counts of_good = misuseOf(good, settings, false), of_some = misuseOf(some, settings, false);
  EXPECT_EQ(of_good.blank_firings, 0U);
  EXPECT_GT(blankFiringsOf(some), 4.0) << "what there is to count";
  EXPECT_NEAR(static_cast<double>(of_some.blank_firings), blankFiringsOf(some), 1.0);
  EXPECT_NEAR(of_good.work_time, 20.0, 1.0);
  // Without boom and pressures hold-down force and place are unknown: the figures are empty, not zero.
  EXPECT_FALSE(of_good.withoutHoldDown() || of_good.still());
}

Counts onRock(double hold_down_force, double stiffness, bool pressures = true) {
  simulation::MachineSettings machine = test::machineOnBoom(1.0, 50.0);
  machine.on_boom.rock = {stiffness, 3.0, hold_down_force};
  const simulation::Session session = simulation::recordSession(machine);
  return misuseOf(session, test::settingsWith("boom: compliant\nhull_motion: model\nboom_stiffness: identified\n"),
                  true, pressures);
}

TEST(Misuse, CountsBlowsWithoutHoldDownForceByPressures) {
  const Counts pressed = onRock(12000.0, 3e7), hangs = onRock(0.0, 0.0);
  ASSERT_GT(pressed.judged_blows, 25U);
  EXPECT_EQ(*pressed.withoutHoldDown(), 0U);
  ASSERT_GT(hangs.judged_blows, 25U);
  EXPECT_GE(*hangs.withoutHoldDown(), hangs.judged_blows * 9 / 10);
  EXPECT_FALSE(onRock(0.0, 0.0, false).withoutHoldDown()) << "no pressures";
}

constexpr double kTurnPeriod = 0.2;

/// Returns the counts for a hull that moves by `advance` [m] with each of 300 blows (60 s).
Counts advancing(double advance) {
  MisuseFollower misuse;
  for (int blow = 0; blow < 300; ++blow) {
    misuse.hullAt({0.0, 0.0, -advance * blow});
    misuse.blow(kTurnPeriod);
  }
  return misuse.counts();
}

TEST(Misuse, HammeringAtOnePlaceCountsBeyondThePatienceOfTheMaker) {
  EXPECT_NEAR(*advancing(0.0).still(), 60.0 - MisuseFollower::kPatience, 1e-9);
  EXPECT_EQ(*advancing(0.001).still(), 0.0) << "20 mm in 4 s";
  EXPECT_NEAR(advancing(0.0).placed_time, 300 * kTurnPeriod, 1e-9);
}

/// The time at one place restarts after a pause, or when the hammer is lifted and set down between two blows.
TEST(Misuse, PausesAndMovesEndTheTimeAtOnePlace) {
  MisuseFollower misuse;
  const auto hammer = [&](double seconds) {
    for (int blow = 0; blow < std::lround(seconds / kTurnPeriod); ++blow) {
      misuse.hullAt(Eigen::Vector3d::Zero());
      misuse.blow(kTurnPeriod);
    }
  };
  hammer(14.0);
  misuse.hullAt({0.3, 0.0, 0.5});  // lifted
  hammer(14.0);
  EXPECT_EQ(*misuse.counts().still(), 0.0);
  misuse.hullLost();
  hammer(14.0);
  EXPECT_EQ(*misuse.counts().still(), 0.0);
  hammer(4.0);
  EXPECT_NEAR(*misuse.counts().still(), 3.0, 1e-9);
}

TEST(Misuse, AHullThatComesBackAfterItsRecoilIsPressed) {
  MisuseFollower misuse;
  const auto turn = [&](std::optional<bool> at_first, std::optional<bool> then) {
    misuse.pressed(at_first);
    misuse.pressed(then);
    misuse.blow(kTurnPeriod);
  };
  turn(false, true);
  turn(true, false);
  EXPECT_EQ(*misuse.counts().withoutHoldDown(), 0U);
  turn(false, false);
  EXPECT_EQ(*misuse.counts().withoutHoldDown(), 1U);
  turn(std::nullopt, false);
  EXPECT_EQ(misuse.counts().judged_blows, 3U);
}

}  // namespace
}  // namespace hammer_loads
