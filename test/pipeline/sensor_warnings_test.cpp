// Warnings about simulated machines with one flaw each, and about machines without flaws.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "support/exact_hammer.h"
#include "support/held_hull.h"

namespace hammer_loads {
namespace {

simulation::MachineSettings longMachineAt(double rate, std::uint64_t seed) {
  simulation::MachineSettings s = simulation::workingMo100();
  s.duration = 12.0;
  s.drive.stop_time = 20.0;
  s.crank.rate = rate;
  s.seed = seed;
  return s;
}

struct Heard {
  std::string keys;
  std::vector<Warning> warnings;
  double covered{};           ///< part of the errors of Fz within two deviations, from 4 s on
  std::vector<double> blows;  ///< stamps [s]
  SampleCounts counts;
};

Heard hear(const simulation::MachineSettings& machine) {
  static const Settings settings = test::withExactHammer(test::heldHull(*load(configDirectory(), {}).value));
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  Heard heard;
  double judged = 0.0;
  const auto take = [&](const SampleResult& result) {
    for (std::size_t i = 0; i < result.turn_ends; ++i)
      heard.blows.push_back(1e-9 * static_cast<double>(result.ends[i].stamp - machine.start_stamp));
  };
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    const simulation::CrankReading& reading = session.crank[i];
    const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    take(result);
    if (!result.isPublished() || session.truth[i].time < 4.0) continue;
    const double error = result.outputs.front().wrench.force_z - session.truth[i].load.force_z;
    judged += 1.0;
    heard.covered += std::abs(error) <= 2.0 * result.outputs.front().deviation.wrench().force_z;
  }
  take(pipeline.end());
  heard.covered /= judged;
  heard.warnings = warningsOf(pipeline);
  heard.counts = pipeline.counts();
  for (const Warning& warning : heard.warnings) {
    if (std::string(warning.key) != "pitch joints") heard.keys += std::string(warning.key) + ";";
  }
  return heard;
}

/// Returns the machine with its hull at rest and upright, so that no joint states are needed.
simulation::MachineSettings upright(simulation::MachineSettings s) {
  for (simulation::JointMotion& joint : s.boom) joint.mean = joint.amplitude = 0.0;
  return s;
}

TEST(SensorWarnings, MachinesWithoutAFlawRaiseNone) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const double rates[] = {100.0, 200.0, 500.0, 1000.0};
    simulation::MachineSettings s = upright(longMachineAt(rates[i % 4], 300 + i));
    s.crank.counts = i % 3 == 0 ? 1024 : 4096;
    s.crank.speed = i % 2 == 0;
    s.drive.inertia *= 0.8 + 0.4 * part(random);
    s.drive.flow *= 0.8 + 0.4 * part(random);
    s.blow.restitution_drawn = i % 2 == 1;
    EXPECT_EQ(hear(s).keys, "") << i;
  }
}

TEST(SensorWarnings, JitterAndStampsThatRepeatAreNamed) {
  simulation::MachineSettings s = upright(longMachineAt(500.0, 42));
  s.crank.stamp_noise = 3e-4;
  EXPECT_EQ(hear(s).keys, "jitter;");
  simulation::MachineSettings bursts = upright(longMachineAt(1000.0, 43));
  bursts.crank.burst = 10;
  EXPECT_NE(hear(bursts).keys.find("stamps;"), std::string::npos);
}

TEST(SensorWarnings, ACouplingThatTwistsIsWithheldAndNamed) {
  simulation::MachineSettings s = upright(longMachineAt(1000.0, 44));
  const std::uint64_t rigid = hear(s).counts.accepted;
  s.drive.coupling_frequency = 50.0;
  const Heard heard = hear(s);
  EXPECT_NE(heard.keys.find("inconsistent;"), std::string::npos) << heard.keys;
  EXPECT_EQ(heard.keys.find("zero;"), std::string::npos) << heard.keys;
  EXPECT_GT(heard.counts.refusedFor(Refusal::kInconsistent), 2 * rigid / 3);
  const auto text = std::find_if(heard.warnings.begin(), heard.warnings.end(),
                                 [](const Warning& w) { return std::string(w.key) == "inconsistent"; });
  ASSERT_NE(text, heard.warnings.end());
  EXPECT_NE(text->text.find("coupling"), std::string::npos) << text->text;
}

/// The samples end before the last blow is completely measured.
TEST(PipelineEnd, TheLastBlowIsGiven) {
  simulation::MachineSettings s = upright(longMachineAt(1000.0, 45));
  const std::vector<simulation::BlowTruth> blows = simulation::recordSession(s).blows;
  s.duration = blows.back().time + 0.01;
  const Heard heard = hear(s);
  ASSERT_FALSE(heard.blows.empty());
  EXPECT_NEAR(heard.blows.back(), blows.back().time, 2e-4);
}

}  // namespace
}  // namespace hammer_loads
