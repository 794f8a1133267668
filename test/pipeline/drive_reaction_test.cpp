/// The drive's part of the published wrench over a working session.
#include <gtest/gtest.h>

#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kSessionEnd;
using test::kSessionWorks;
using test::Player;
using test::settingsWith;

/// Compares the impulse of the drive's part with the crank's gain in speed between the blows.
TEST(DrivesPart, IsTheRotorsChangeOfSpeedBetweenTheBlowsForMeans) {
  Player player(settingsWith("output: mean\n"));
  double impulse = 0.0, smooth = 0.0, inertia = 0.0, begin = 0.0, end = 0.0, jumps = 0.0;
  player.playTo(3.0, [](double, const SampleResult&) {});
  bool first = true;
  player.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    ASSERT_FALSE(result.refusal);
    if (first) begin = result.crank.speed;
    for (const WrenchOutput& output : result.outputs)
      impulse += first ? 0.0 : output.drive_reaction_y * output.interval;
    for (const CrankStep::Passage& passage : player.pipeline.crank().step())
      if (!first) jumps += passage.speed_after - passage.speed_before;
    first = false;
    end = result.crank.speed;
    inertia = player.pipeline.crank().tracker().driveInertia();
  });
  smooth = end - begin - jumps;
  // Jc is still being estimated, and each sample corrects the speed: some 0.1 % of the sum of all changes.
  EXPECT_NEAR(impulse, -inertia * smooth, 0.05 * inertia * std::abs(jumps) + 0.5);
}

TEST(DrivesPart, IsThatOfTheEstimateAndNothingElse) {
  Player with(settingsWith("output: instantaneous\n")), without(settingsWith("drive_reaction_ratio: 0.0\n"));
  std::vector<double> torque, part;
  double largest = 0.0;
  with.playTo(kSessionEnd, [&](double time, const SampleResult& result) {
    for (const WrenchOutput& output : result.outputs) {
      torque.push_back(output.wrench.torque_y), part.push_back(output.drive_reaction_y);
      EXPECT_EQ(output.drive_reaction_y, -with.pipeline.crank().tracker().driveInertia() * output.crank.acceleration);
      if (time > kSessionWorks) largest = std::max(largest, std::abs(output.drive_reaction_y));
    }
  });
  std::size_t i = 0;
  without.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    for (const WrenchOutput& output : result.outputs) {
      EXPECT_EQ(output.drive_reaction_y, 0.0);
      EXPECT_NEAR(output.wrench.torque_y, torque.at(i) - part.at(i), 1e-9);
      ++i;
    }
  });
  EXPECT_EQ(i, torque.size());
  EXPECT_GT(largest, 500.0);
}

}  // namespace
}  // namespace hammer_loads
