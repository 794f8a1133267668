// Tests limits on simulated machines of known energy and strokes, and against hand calculations.
#include "hammer_loads/pipeline/limit_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/session_player.h"

namespace hammer_loads {
namespace {

Limit energyLimit(bool least, double warn, double error) {
  return {least ? "blow_energy_least" : "blow_energy_greatest", "J", LimitedQuantity::kBlowEnergy, least, warn, error};
}

simulation::Session workWithFlow(double flow, double blank_share = 0.0) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 12.0;
  machine.drive.flow *= flow;
  machine.blow.blank_share = blank_share;
  return simulation::recordSession(machine);
}

double medianEnergy(const simulation::Session& session) {
  std::vector<double> energies;
  for (const simulation::BlowTruth& blow : session.blows) energies.push_back(blow.strike.energy);
  std::nth_element(energies.begin(), energies.begin() + energies.size() / 2, energies.end());
  return energies[energies.size() / 2];
}

/// Judges a session; done(states of the limits) is called after each revolution that ends within 4 to 11 s.
template <typename Done>
LimitWatch judged(const simulation::Session& session, const std::vector<Limit>& limits, const Done& done) {
  test::Player player(test::settingsWith("boom: none\n"), false, session);
  LimitWatch watch(limits, {}, {});
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    for (std::size_t i = 0; i < result.turn_ends; ++i) {
      watch.judge(result.ends[i], player.pipeline.counts().misuse, {});
      if (time > 4.0 && time < 11.0) done(watch.states());
    }
  });
  return watch;
}

TEST(Limits, DistinguishAWeakMachineFromAStrongOne) {
  const simulation::Session strong = workWithFlow(1.0), weak = workWithFlow(0.8);
  const double more = medianEnergy(strong), less = medianEnergy(weak), between = 0.5 * (more + less);
  ASSERT_LT(less, 0.8 * more) << "by the simulated impact";
  for (const bool is_weak : {false, true}) {
    int turns = 0;
    judged(is_weak ? weak : strong, {energyLimit(true, between, 0.5 * less), energyLimit(false, between, 2.0 * more)},
           [&](const std::vector<LimitState>& states) {
             ++turns;
             EXPECT_EQ(states[0].level, is_weak ? AlarmLevel::kWarn : AlarmLevel::kOk) << states[0].value;
             EXPECT_EQ(states[1].level, is_weak ? AlarmLevel::kOk : AlarmLevel::kWarn) << states[1].value;
             EXPECT_NEAR(states[0].value, is_weak ? less : more, 0.06 * more);
             EXPECT_GT(states[0].std, 0.0);
           });
    EXPECT_GT(turns, 20);
  }
}

TEST(Limits, CountTheStrokesThatFindNoTool) {
  const simulation::Session session = workWithFlow(1.0, 0.2);
  // Blank firings follow from the true angle: the crank passes two dead centres for each.
  const double blank =
      0.5 * static_cast<double>(session.truth.back().turn - static_cast<std::int64_t>(session.blows.size()));
  ASSERT_GT(blank, 3.0);
  const LimitWatch watch = judged(
      session, {{"blank_firing_per_hour", "1/h", LimitedQuantity::kBlankFiring, false, 0.5 * blank, 2.0 * blank}},
      [](const std::vector<LimitState>&) {});
  EXPECT_NEAR(watch.states()[0].value, blank, 1.0) << "12 s are not extrapolated to an hour";
  EXPECT_EQ(watch.states()[0].level, AlarmLevel::kWarn);
}

TurnEnd turnOf(double energy, StampNs stamp) {
  TurnEnd end;
  end.stamp = stamp;
  end.blow.energy = energy;
  end.blow.energy_std = 400.0;
  return end;
}

TEST(Limits, AreExceededByTheValueAloneAndKeptWhereItIsNotKnown) {
  LimitWatch watch({energyLimit(false, 1000.0, 2000.0), energyLimit(true, 500.0, kNaN)}, {}, {});
  const auto judge = [&](double energy, StampNs stamp) { return watch.judge(turnOf(energy, stamp), {}, {}); };
  const auto levels = [&] { return std::make_pair(watch.states()[0].level, watch.states()[1].level); };
  const AlarmLevel ok = AlarmLevel::kOk, warn = AlarmLevel::kWarn, error = AlarmLevel::kError;
  EXPECT_TRUE(judge(1000.0, 10)) << "the first turn says that all is well";
  EXPECT_EQ(levels(), std::make_pair(ok, ok)) << "at the limit, whatever the standard deviation";
  EXPECT_FALSE(judge(500.0, 20));
  EXPECT_TRUE(judge(1000.5, 30));
  EXPECT_EQ(levels(), std::make_pair(warn, ok));
  EXPECT_EQ(watch.states()[0].limit, 1000.0);
  EXPECT_EQ(watch.states()[0].std, 400.0);
  EXPECT_TRUE(judge(1900.0, 40));
  EXPECT_EQ(watch.states()[0].since, 30);
  EXPECT_TRUE(judge(2100.0, 50));
  EXPECT_EQ(levels(), std::make_pair(error, ok));
  EXPECT_TRUE(judge(kNaN, 60));
  EXPECT_EQ(levels(), std::make_pair(error, ok)) << "not known: no news";
  EXPECT_EQ(watch.states()[0].since, 50);
  EXPECT_TRUE(judge(499.0, 70));
  EXPECT_EQ(levels(), std::make_pair(ok, warn));
  EXPECT_TRUE(judge(800.0, 80)) << "the end of an alarm is published";
  EXPECT_FALSE(judge(800.0, 90));
}

TEST(Limits, SumTheDamageOfTheLastHour) {
  const life::LoadGrid grid = *life::LoadGrid::make(-500.0, 500.0, 1000).value;  // classes of 1 MPa
  life::CountedChannel weld{"stress/weld", grid};
  weld.curve = life::SnCurve::make(50.0, 1e6, 3.0, 5.0).value;
  const Limit limit{"weld_damage_per_hour", "1/h", LimitedQuantity::kDamage, false, 3.9e-2, kNaN, "stress/weld"};
  LimitWatch watch({limit}, {{"hull_wrench/force_z", grid}, weld}, {});
  // 1000 cycles of 100 MPa in each minute of three hours, twice as many in the second hour.
  life::LifePiece piece;
  piece.counts = {life::CycleCount(grid), life::CycleCount(grid)};
  std::uint64_t cycles = 0;
  std::vector<double> hours;
  for (std::uint64_t minute = 0; minute < 180; ++minute) {
    cycles += minute / 60 == 1 ? 2000 : 1000;
    piece.counts[1].closed = {{100, 400, cycles}};
    piece.duration = minute * 60'000'000'000 + 30'000'000'000;
    MisuseCounts work;
    work.work_time = 1e-9 * static_cast<double>(piece.duration);
    watch.judge(turnOf(0.0, static_cast<StampNs>(piece.duration)), work, piece);
    if (minute % 60 == 59) hours.push_back(watch.states()[0].value);
  }
  // Palmgren-Miner by hand: n (100/50)^3 / 1e6.
  ASSERT_EQ(hours.size(), 3U);
  EXPECT_NEAR(hours[0], 60.0 * 1000.0 * 8e-6, 1e-12);
  EXPECT_NEAR(hours[1], 60.0 * 2000.0 * 8e-6, 1e-12);
  EXPECT_NEAR(hours[2], 60.0 * 1000.0 * 8e-6, 1e-12);
  EXPECT_EQ(watch.states()[0].level, AlarmLevel::kWarn);
  // The log is stopped: the count restarts, the work time continues.
  MisuseCounts work;
  work.work_time = 180.0 * 60.0 + 30.0;
  piece.counts[1].closed = {{100, 400, 500}};
  piece.duration = 30'000'000'000;
  watch.judge(turnOf(0.0, 1), work, piece);
  EXPECT_NEAR(watch.states()[0].value, (59.0 * 1000.0 + 500.0) * 8e-6, 1e-12);
}

}  // namespace
}  // namespace hammer_loads
