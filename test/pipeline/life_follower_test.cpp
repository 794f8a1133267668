/// Turn loads and cycles of a session against the machine's own loads, which know no samples.
#include "hammer_loads/pipeline/life_follower.h"

#include <gtest/gtest.h>

#include <map>

#include "support/counting_new.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kPeak = 8.6e3;  // [N], about, of the session's turns

/// Runs a session through pipeline and follower; each(result, follower) after every sample.
template <typename Each>
void run(const Settings& settings, const simulation::Session& session, const Each& each) {
  test::Player player(settings, true, session);
  LifeFollower follower(player.pipeline, settings.life);
  player.playTo(1e9, [&](double, const SampleResult& result) {
    if (follower.due()) follower.take();
    follower.follow();
    each(result, follower);
  });
}

simulation::Session sessionAt(double rate, const std::vector<simulation::CrankSensorSettings::Interval>& drop_outs) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = test::kSessionEnd;
  machine.crank.rate = rate;
  machine.crank.drop_outs = drop_outs;
  return simulation::recordSession(machine);
}

TEST(TurnLoads, OfTheHullHaveThePulsesPeakAtAnyRate) {
  for (const double rate : {100.0, 1000.0}) {
    std::size_t turns = 0;
    run(test::settingsWith("{}"), sessionAt(rate, {}), [&](const SampleResult& result, const LifeFollower& follower) {
      for (std::size_t i = 0; i < result.turn_ends; ++i) {
        const life::TurnLoads* turn = follower.turnLoads(result.ends[i]);
        ASSERT_NE(turn, nullptr);
        ASSERT_EQ(turn->whole, result.ends[i].pulse.has_value());
        if (!turn->whole) continue;
        ++turns;
        // The pulse's amplitude is that of a parabola through points 1.25 ms apart, along the turn's own track.
        EXPECT_NEAR(turn->maximum[1], result.ends[i].pulse->amplitude, 5e-4 * kPeak) << rate;
        EXPECT_NEAR(turn->mean[1], result.ends[i].pulse->turn_impulse_z / result.ends[i].pulse->period, 0.01 * kPeak)
            << rate;
      }
    });
    EXPECT_GT(turns, 8U) << rate;
  }
}

}  // namespace
}  // namespace hammer_loads
