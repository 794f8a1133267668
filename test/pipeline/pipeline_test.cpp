#include "hammer_loads/pipeline/pipeline.h"

#include <gtest/gtest.h>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/mo100.h"
#include "support/session_bounds.h"

namespace hammer_loads {
namespace {

using simulation::MachineSettings;
using simulation::Session;

using test::kCrank;

const Settings& shippedSettings() {
  static const Settings settings = *loadFiles(configDirectory(), {}).value;
  return settings;
}

MachineSettings machineWithDropOut(std::uint64_t seed, double rate) {
  MachineSettings machine = simulation::workingMo100();
  machine.seed = seed;
  machine.duration = 12.0;
  machine.drive.stop_time = 10.5;
  machine.crank.rate = rate;
  machine.crank.drop_outs = {{6.0 + 0.03 * static_cast<double>(seed), 6.1 + 0.03 * static_cast<double>(seed)}};
  return machine;
}

struct Case {
  std::uint64_t seed;
  double inertia_guess;
  double speed_noise;
  double true_inertia;
  bool speed;
};

class UnseenSessions : public testing::TestWithParam<Case> {};

TEST_P(UnseenSessions, StayWithinTheBounds) {
  for (const auto& [rate, bounds] : {std::pair{1000.0, test::kBounds1kHz}, std::pair{100.0, test::kBounds100Hz}}) {
    MachineSettings machine = machineWithDropOut(GetParam().seed, rate);
    machine.crank.speed_noise = GetParam().speed_noise;
    machine.crank.speed = GetParam().speed;
    machine.drive.inertia = GetParam().true_inertia;
    HammerParameters hammer = machine.hammer;
    hammer.drive_inertia = GetParam().inertia_guess * machine.drive.inertia;
    const Session session = simulation::recordSession(machine);
    const accuracy::SessionRun run =
        accuracy::runSession(session, machine.start_stamp, test::mechanismOf(hammer), shippedSettings().pipeline);
    SCOPED_TRACE(rate);
    const accuracy::SessionErrors errors = accuracy::judge(run, session, machine);
    test::expectWithin(errors, bounds);
    EXPECT_GT(errors.blows, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, UnseenSessions,
                         testing::Values(Case{1, 1.0, 0.15, 0.6, true}, Case{2, 0.5, 0.15, 0.6, true},
                                         Case{3, 1.5, 0.15, 0.8, true}, Case{4, 1.0, 0.6, 0.6, true},
                                         Case{5, 1.0, 0.03, 0.5, true}, Case{6, 1.5, 0.15, 0.6, false}));

TEST(Pipeline, HasNoErrorOfTenPercentAfterADropOut) {
  for (const double gap : {0.03, 0.1, 0.4}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      MachineSettings machine = machineWithDropOut(seed, 1000.0);
      machine.duration = 7.5;
      machine.drive.stop_time = 7.4;
      machine.crank.drop_outs = {
          {6.0 + 0.05 * static_cast<double>(seed), 6.0 + 0.05 * static_cast<double>(seed) + gap}};
      const Session session = simulation::recordSession(machine);
      const accuracy::SessionRun run = accuracy::runSession(
          session, machine.start_stamp, test::mechanismOf(machine.hammer), shippedSettings().pipeline);
      double peak = 0, worst = 0;
      std::size_t next = 0;
      for (const auto& t : session.truth) {
        while (next < run.wrenches.size() && run.wrenches[next].time < t.time - 1e-5) ++next;
        peak = std::max(peak, std::abs(t.load.force_z));
        if (t.time < 5.0 || next == run.wrenches.size() || std::abs(run.wrenches[next].time - t.time) > 1e-5) continue;
        worst = std::max(worst, std::abs(run.wrenches[next].force_z - t.load.force_z));
      }
      EXPECT_LE(worst, 0.1 * peak) << gap << ' ' << seed;
      EXPECT_LT(run.counts.refused[static_cast<std::size_t>(Refusal::kUnsettled)], 50u) << "output must come back";
    }
  }
}

TEST(Pipeline, CountsEveryRefusalByItsReason) {
  Pipeline pipeline(test::mechanismOf(test::mo100Parameters()), shippedSettings().pipeline);
  const auto refusal = [&](StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& position,
                           const std::vector<double>& velocity) {
    return pipeline.crankJoint(stamp, names, position, velocity).refusal;
  };
  EXPECT_FALSE(refusal(1000000, kCrank, {1.0}, {10.0}));
  EXPECT_EQ(refusal(2000000, {"wheel"}, {1.0}, {10.0}), Refusal::kMissingJoint);
  EXPECT_EQ(refusal(2000000, kCrank, {}, {10.0}), Refusal::kShortArray);
  EXPECT_EQ(refusal(2000000, {"wheel", "hammer_crank_joint"}, {1.0, 1.0}, {1.0}), Refusal::kShortArray);
  EXPECT_EQ(refusal(2000000, kCrank, {std::nan("")}, {10.0}), Refusal::kNotFinite);
  EXPECT_EQ(refusal(1000000, kCrank, {1.0}, {10.0}), Refusal::kDuplicate);
  EXPECT_EQ(refusal(2000000, kCrank, {3.0}, {10.0}), Refusal::kImplausible);
  EXPECT_EQ(refusal(kLastStamp + 1, kCrank, {1.01}, {10.0}), Refusal::kBadStamp);
  EXPECT_FALSE(refusal(2000000, {"wheel", "hammer_crank_joint"}, {1.0, 1.01}, {}));
  for (std::size_t i = 0; i < kRefusalNames.size(); ++i) {
    const std::uint64_t expected = i == static_cast<std::size_t>(Refusal::kShortArray) ? 2
                                   : i == static_cast<std::size_t>(Refusal::kOutOfOrder) ||
                                           i == static_cast<std::size_t>(Refusal::kUnsettled) ||
                                           (i >= static_cast<std::size_t>(Refusal::kDegrees) &&
                                            i <= static_cast<std::size_t>(Refusal::kInconsistent))
                                       ? 0
                                       : 1;
    EXPECT_EQ(pipeline.counts().refused[i], expected) << kRefusalNames[i];
  }
  EXPECT_EQ(pipeline.counts().accepted, 2u);
}

TEST(Pipeline, ABlowIsOnlyWhatStrikes) {
  Pipeline pipeline(test::mechanismOf(test::mo100Parameters()), shippedSettings().pipeline);
  std::size_t blows = 0;
  const auto swing = [&](StampNs from, double amplitude, double center) {
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i, angle = center + amplitude * std::sin(3.0 * t);
      blows +=
          pipeline.crankSample(from + static_cast<StampNs>(i) * 1000000, {angle, 3.0 * amplitude * std::cos(3.0 * t)})
              .turn_ends;
    }
  };
  swing(0, 0.05, kTwoPi);  // creeps back and forth across the blow
  EXPECT_EQ(blows, 0u);
}

}  // namespace
}  // namespace hammer_loads
