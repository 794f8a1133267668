// From where on a warning is said, and what it takes for the reason: each bound within a factor of 1.25 to 1.5 of what
// is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr double kWorksFrom = 0.1, kFlawless = 6.0;  // [s]

simulation::MachineSettings machineFor(double duration) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = duration;
  machine.drive.start_time = kWorksFrom;
  machine.drive.stop_time = 20.0;
  machine.crank.drop_outs.clear();
  return machine;
}

/// Of the warning with that key; empty: none.
std::string saidOf(const Pipeline& pipeline, const std::string& key) {
  for (const Warning& warning : warningsOf(pipeline))
    if (warning.key == key) return warning.text;
  return {};
}

TEST(WarningNumbers, ATenthOfTheSamplesTellsTheUnit) {
  for (const std::uint64_t wrong : {80U, 125U}) {
    SampleCounts counts;
    counts.accepted = 1000;
    counts.refused[static_cast<std::size_t>(Refusal::kSpeedUnit)] = wrong;
    EXPECT_EQ(counts.contradictSince({}), wrong > 100);
  }
}

TEST(WarningNumbers, StampsThatJitterByATenthOfAMillisecond) {
  for (const double jitter : {0.7e-4, 1.4e-4}) {
    simulation::MachineSettings machine = machineFor(kFlawless);
    machine.crank.stamp_noise = jitter;
    const simulation::Session session = simulation::recordSession(machine);
    test::Player player(test::settingsWith("{}"), false, session);
    player.playTo(kFlawless, [](double, const SampleResult&) {});
    EXPECT_EQ(saidOf(player.pipeline, "jitter") != "", jitter > 1e-4) << jitter;
  }
}

TEST(WarningNumbers, NothingIsSaidOfASensorBeforeTenBlows) {
  simulation::MachineSettings machine = machineFor(kFlawless);
  machine.crank.stamp_noise = 2e-4;
  const simulation::Session session = simulation::recordSession(machine);
  test::Player player(test::settingsWith("{}"), false, session);
  std::uint64_t first = 0;
  player.playTo(kFlawless, [&](double, const SampleResult& result) {
    if (first == 0 && result.turn_ends > 0 && saidOf(player.pipeline, "jitter") != "")
      first = player.pipeline.counts().blows;
  });
  EXPECT_GE(first, 8U);
  EXPECT_LE(first, 13U);
}

/// A unit that stands still on its hull, but for a little.
std::string heardOfImu(double force) {
  const Settings settings = test::settingsWith("hull_motion: imu\n");
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  pipeline.boomJoints(0, test::kFour, {0.0, 0.0, 0.0, 0.0}, {});
  pipeline.crankSample(test::kMs, {0.5, 0.0});
  for (int i = 0; i < 5000; ++i) {
    ImuReading reading = test::atRest(0.0, settings.pipeline.imu);
    reading.specific_force *= (force + (i % 2 == 0 ? 1e-3 : -1e-3)) / test::kGravity;
    pipeline.hullImu(i * test::kMs, reading);
  }
  return saidOf(pipeline, "imu");
}

TEST(WarningNumbers, AWeightWithinAFifthOfOneIsInG) {
  for (const double force : {1.0 / 1.1, 1.1}) EXPECT_NE(heardOfImu(force).find("in g, must"), std::string::npos);
  for (const double force : {1.0 / 1.4, 1.4}) {
    EXPECT_EQ(heardOfImu(force).find("in g, must"), std::string::npos);
    EXPECT_NE(heardOfImu(force).find("by the joint angles"), std::string::npos);
  }
}

/// A tenth of what air has holds no boom.
TEST(WarningNumbers, PressuresOfNoCylinderAreInAnotherUnit) {
  const Settings settings = accuracy::shippedBoom("{boom: compliant, hull_motion: model}");
  simulation::MachineSettings machine = accuracy::machineOnBoom(1.5);
  machine.drive.start_time = 5.0;
  const simulation::Session right = simulation::recordSession(machine);
  double greatest = 0.0;
  for (const simulation::PressureReading& r : right.pressures)
    for (std::size_t i = 0; i < 3; ++i) greatest = std::max({greatest, std::abs(r.bore[i]), std::abs(r.rod[i])});
  for (const double as : {0.8e4, 1.25e4}) {
    simulation::Session session = right;
    for (simulation::PressureReading& r : session.pressures)
      for (std::size_t i = 0; i < 3; ++i) r.bore[i] *= as / greatest, r.rod[i] *= as / greatest;
    test::Player player(settings, true, session);
    player.playTo(1.5, [](double, const SampleResult&) {});
    const std::string text = saidOf(player.pipeline, "pressures");
    EXPECT_EQ(text.find("must be in Pa") != std::string::npos, as < 1e4) << as << ": " << text;
    EXPECT_NE(text.find("not used"), std::string::npos) << as;
  }
}

}  // namespace
}  // namespace hammer_loads
