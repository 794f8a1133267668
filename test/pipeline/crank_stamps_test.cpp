// Instants of crank samples whose stamps repeat, are rounded or jitter, on machines that make them hard to find.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

simulation::MachineSettings eightSeconds() {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = 8.0;
  machine.drive.stop_time = 20.0;
  machine.crank.drop_outs.clear();
  return machine;
}

/// Returns the eight-second machine with crank and rod as given by the settings.
simulation::MachineSettings eightSecondsOf(const Settings& settings) {
  simulation::MachineSettings machine = eightSeconds();
  machine.hammer = settings.mechanism.parameters();
  machine.level = Level::kLinkage;
  return machine;
}

double secondsOf(StampNs stamp, const simulation::MachineSettings& machine) {
  return seconds(stamp - machine.start_stamp);
}

/// Returns the blow within 30 ms of a time [s]; null if there is none.
const simulation::BlowTruth* blowNear(double time, const simulation::Session& session) {
  const auto near = [time](const auto& each) { return std::abs(each.time - time) < 0.03; };
  const auto found = std::find_if(session.blows.begin(), session.blows.end(), near);
  return found == session.blows.end() ? nullptr : &*found;
}

/// Results for the samples that were taken from an instant on.
struct Instants {
  std::size_t samples{}, accepted{};
  std::vector<double> errors;  ///< absolute errors of the accepted samples' stamps [s]
  std::vector<TurnEnd> turns;
  bool steady{};
  double worst() const { return errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end()); }
};

Instants instantsOf(const simulation::Session& session, const simulation::MachineSettings& machine,
                    const Settings& settings, double from = 3.0) {
  test::Player player(settings, false, session);
  Instants found;
  std::size_t i = 0;
  player.playTo(8.0, [&](double, const SampleResult& result) {
    const double instant = session.taken[i++];
    if (instant < from) return;
    ++found.samples;
    if (result.refusal) return;
    ++found.accepted;
    found.errors.push_back(std::abs(secondsOf(result.stamp, machine) - instant));
    found.turns.insert(found.turns.end(), result.ends.begin(), result.ends.begin() + result.turn_ends);
  });
  found.steady = player.pipeline.crank().stamps().isSteady();
  return found;
}

/// Messages come in bursts or on whole milliseconds, some twice, without speeds. A reading that a turning crank cannot
/// repeat is not a new one. Readings at rest do not contribute to the line through the stamps.
TEST(CrankTwice, BurstsWithoutSpeedsKeepTheirInstants) {
  for (const bool bursts : {true, false}) {
    simulation::MachineSettings machine = eightSeconds();
    machine.crank.speed = false;
    machine.crank.duplicate_share = 0.03;
    if (bursts)
      machine.crank.burst = 3;
    else
      machine.crank.stamp_step = 1e-3;
    const Instants found = instantsOf(simulation::recordSession(machine), machine, test::settingsWith("{}"));
    EXPECT_LT(found.worst(), 1.1e-3) << bursts << " [s]";
    EXPECT_GT(static_cast<double>(found.accepted), 0.95 * static_cast<double>(found.samples)) << bursts;
  }
}

/// The stamp of a burst does not show which of its samples was lost. If the readings show a later loss, the sample that
/// was counted too late moves back. Before, energies were twice the true ones, and forces were wrong by their peak.
TEST(CrankLosses, AreWhereTheReadingsHaveThemWithinBursts) {
  const Settings settings = test::settingsWith("{}");
  // From the fourth case on, a sample is lost within the first bursts. All later instants used to stay wrong.
  for (const auto& [rate, burst, seed] : {std::tuple{200.0, 3, 1u},
                                          {500.0, 3, 1u},
                                          {1000.0, 3, 1u},
                                          {500.0, 10, 4u},
                                          {500.0, 10, 6u},
                                          {500.0, 10, 7u},
                                          {200.0, 7, 4u},
                                          {1000.0, 5, 6u}}) {
    SCOPED_TRACE(testing::Message() << rate << " Hz, bursts of " << burst);
    simulation::MachineSettings machine = eightSecondsOf(settings);
    machine.seed = seed;
    machine.crank.rate = rate;
    machine.crank.burst = burst;
    machine.crank.loss_share = 0.01;
    const simulation::Session session = simulation::recordSession(machine);
    const Instants found = instantsOf(session, machine, settings);
    const auto late = std::count_if(found.errors.begin(), found.errors.end(),
                                    [period = 1.0 / rate](double e) { return e > 0.5 * period; });
    EXPECT_LT(static_cast<double>(late), 0.002 * static_cast<double>(found.accepted));  // wrong until the next sample
    std::size_t blows = 0;
    for (const TurnEnd& end : found.turns) {
      const simulation::BlowTruth* truth = blowNear(secondsOf(end.stamp, machine), session);
      if (!truth || secondsOf(end.stamp, machine) < 3.0) continue;
      ++blows;
      EXPECT_NEAR(end.blow.energy / truth->strike.energy, 1.0, 0.05) << secondsOf(end.stamp, machine);
    }
    EXPECT_GT(blows, 15u);
  }
}

/// Single late stamps and single lost samples look alike until the next stamp; the angle distinguishes them at once.
TEST(CrankLosses, DifferFromLateStamps) {
  const Settings settings = test::settingsWith("crank_stamps: steady");
  for (const double rate : {200.0, 1000.0}) {
    for (const double noise : {0.05, 0.2}) {
      SCOPED_TRACE(testing::Message() << rate << " Hz, noise of " << noise << " intervals");
      simulation::MachineSettings machine = eightSeconds();
      machine.crank.rate = rate;
      machine.crank.stamp_noise = noise / rate;
      machine.crank.loss_share = 0.004;
      machine.crank.driver = {0.0, 0.01, 2e-2};
      machine.crank.drop_outs.push_back({5.0, 5.1});
      const Instants found = instantsOf(simulation::recordSession(machine), machine, settings);
      EXPECT_LT(found.worst(), 0.5 / rate) << " [s]";
      EXPECT_GE(found.turns.size(), 20U);
    }
  }
}

/// Returns the number of samples whose error exceeds four of their standard deviations and 5 % of the peak, and the
/// largest deviation over the peak.
std::pair<int, double> falseSamples(const simulation::MachineSettings& machine, const Settings& settings, double from) {
  const simulation::Session session = simulation::recordSession(machine);
  const accuracy::SessionRun run =
      accuracy::runSession(session, machine.start_stamp, settings.mechanism, settings.pipeline);
  std::vector<double> times;
  for (const accuracy::WrenchAt& w : run.wrenches) times.push_back(w.time);
  const std::vector<simulation::CrankTruth> truth = simulation::truthAt(machine, times);
  double peak = 0.0, largest = 0.0;
  for (const simulation::CrankTruth& t : session.truth) peak = std::max(peak, std::abs(t.load.force_z));
  int wrong = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const accuracy::WrenchAt& w = run.wrenches[i];
    const double error = std::abs(w.force_z - truth[i].load.force_z);
    wrong += times[i] > from && error > std::max(4.0 * w.force_z_std, 0.05 * peak);
    largest = std::max(largest, w.force_x_std / peak);
  }
  return {wrong, largest};
}

/// After a gap the line through the stamps must be found again. Until then stamps that jittered are taken with that
/// jitter, and those of bursts not at all. Forces were wrong by their peak, with standard deviations of a few percent.
TEST(CrankGap, IsFollowedByNothingFalse) {
  const Settings settings = test::settingsWith("{}");
  for (const int burst : {1, 2, 6}) {
    for (const double end : {4.62, 4.71, 4.84}) {
      simulation::MachineSettings machine = eightSecondsOf(settings);
      machine.crank.speed = false;
      machine.crank.burst = burst;
      machine.crank.stamp_noise = burst == 6 ? 0.0 : 7e-4;
      machine.crank.drop_outs.push_back({4.0, end});
      EXPECT_EQ(falseSamples(machine, settings, 4.0).first, 0) << burst << ", " << end;
    }
  }
}

/// Before the first revolution no peak is known for comparison. Forces of 21 times the peak were published, with a
/// standard deviation of 41 times.
TEST(CrankJitter, PublishesNoForceWhoseDeviationExceedsEveryForce) {
  const Settings settings = test::settingsWith("{}");
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    simulation::MachineSettings machine = eightSecondsOf(settings);
    machine.seed = seed;
    machine.crank.rate = 2000.0;
    machine.crank.counts = 512;
    machine.crank.speed = false;
    machine.crank.stamp_noise = 1e-3;
    machine.crank.driver = {0.0, 0.01, 1.9e-3};
    EXPECT_LT(falseSamples(machine, settings, 8.0).second, 5.0) << seed;  // the peak at constant speed is 4 times it
  }
}

/// No reading shows a latency that all stamps have in common, so that only its stated deviation covers it.
TEST(CrankLatency, IsCoveredByItsDeviation) {
  simulation::MachineSettings machine = eightSeconds();
  machine.crank.latency = 5e-3;
  const simulation::Session session = simulation::recordSession(machine);
  const auto covered = [&](const char* keys) {
    const Settings settings = test::settingsWith(keys);
    const accuracy::SessionRun run =
        accuracy::runSession(session, machine.start_stamp, settings.mechanism, settings.pipeline);
    return accuracy::judgeAtStamps(run, session, machine, 0.0).z.covered;
  };
  EXPECT_LT(covered("{crank_latency_std_s: 0, withhold_above: 10}"), 0.75);
  EXPECT_GT(covered("{crank_latency_std_s: 0.005, withhold_above: 10}"), 0.88);
}

/// A controller samples in its task of 4 ms, averages two readings and sends at another rate; its clock is not exactly
/// that of the stamps. The constant part of their age shows in no reading.
TEST(CrankTask, IsNamedAndCovered) {
  const Settings settings = test::settingsWith("{}");
  for (const double task : {3e-3, 4.0002e-3}) {
    for (const int mean : {1, 2}) {
      SCOPED_TRACE(testing::Message() << task << " s, mean of " << mean);
      simulation::MachineSettings machine = eightSeconds();
      machine.duration = 12.0;
      machine.crank.rate = 100.0;
      machine.crank.latency = 0.4e-3;
      machine.crank.task_period = task;
      machine.crank.task_mean = mean;
      const simulation::Session session = simulation::recordSession(machine);
      test::Player player(settings, false, session);
      player.playTo(12.0, [](double, const SampleResult&) {});
      const std::vector<Warning> warnings = warningsOf(player.pipeline);
      const auto isTask = [](const Warning& warning) { return std::string(warning.key) == "task"; };
      const auto named = std::find_if(warnings.begin(), warnings.end(), isTask);
      ASSERT_NE(named, warnings.end());
      EXPECT_NE(named->text.find(task < 3.5e-3 ? "3 ms" : "4 ms"), std::string::npos);
      EXPECT_LE(named->text.size(), 140u);
      const accuracy::SessionRun run =
          accuracy::runSession(session, machine.start_stamp, settings.mechanism, settings.pipeline);
      const accuracy::SessionErrors errors = accuracy::judgeAtStamps(run, session, machine, 0.0);
      EXPECT_GT(std::min({errors.x.covered, errors.z.covered, errors.torque.covered}), 0.88);
    }
  }
}

/// One stamp in a hundred is late by some milliseconds, in order. The angle shows that its sample is not late. After a
/// few such stamps, all samples get the instants of equal intervals.
TEST(CrankLateStamps, AreRefittedThoughInOrder) {
  simulation::MachineSettings machine = eightSeconds();
  machine.crank.rate = 200.0;
  machine.crank.driver = {0.0, 0.01, 4e-3};
  const Instants found = instantsOf(simulation::recordSession(machine), machine, test::settingsWith("{}"), 5.0);
  EXPECT_TRUE(found.steady);
  EXPECT_LT(found.worst(), 5e-4) << " [s]";
}

/// At equal intervals, a reading ahead of its prediction shows lost samples. A vibrating rod moves a crank by as much.
/// Instants were wrong by half a second, and blows were found where there was none.
TEST(CrankOnARodThatGives, LosesNoSamplesToItsVibration) {
  const Settings settings = test::settingsWith("{}");
  simulation::MachineSettings machine = eightSecondsOf(settings);
  machine.rod.stiffness = 5e8;
  machine.rod.damping_ratio = 0.2;
  for (const bool bursts : {true, false}) {
    machine.crank.burst = bursts ? 3 : 1;
    machine.crank.stamp_noise = bursts ? 0.0 : 5e-4;
    const simulation::Session session = simulation::recordSession(machine);
    const Instants found = instantsOf(session, machine, settings);
    for (const TurnEnd& end : found.turns) {
      const double blow = secondsOf(end.stamp, machine);
      EXPECT_TRUE(blowNear(blow, session)) << blow;
    }
    EXPECT_LT(found.worst(), bursts ? 5e-4 : 3e-3) << " [s]";
  }
}

}  // namespace
}  // namespace hammer_loads
