#include "hammer_loads/pipeline/wrench_sampler.h"

#include <gtest/gtest.h>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using simulation::MachineSettings;
using simulation::Session;

MachineSettings machineAt(double crank_rate) {
  MachineSettings machine = simulation::workingMo100();
  machine.duration = 5.2;
  machine.drive.stop_time = 5.1;
  machine.crank.rate = crank_rate;
  machine.crank.drop_outs.clear();
  machine.crank.jitter = machine.crank.stamp_noise = 0.0;  // stamps on the grid of every output rate
  return machine;
}

struct Total {
  double x{}, z{}, about_d{};
  double time{};  ///< covered by the intervals [s]
  std::size_t outputs{};
  StampNs first{}, last{};
};

/// Sums the outputs up to `until` [ns after the first sample].
Total sum(const Session& session, const MachineSettings& machine, PipelineSettings settings, StampNs until) {
  Pipeline pipeline(test::mechanismOf(machine.hammer), settings);
  Total total;
  for (const auto& reading : session.crank) {
    for (const WrenchOutput& output : pipeline.crankSample(reading.stamp, {reading.angle, reading.speed}).outputs) {
      if (output.stamp > session.crank.front().stamp + until) continue;
      if (total.outputs++ == 0) total.first = output.stamp;
      total.last = output.stamp;
      total.x += output.wrench.force_x * output.interval;
      total.z += output.wrench.force_z * output.interval;
      total.about_d += output.wrench.torque_y * output.interval;
      total.time += output.interval;
    }
  }
  return total;
}

PipelineSettings settingsOf(Level level, OutputKind kind, double rate) {
  PipelineSettings settings = loadFiles(configDirectory(), {}).value->pipeline;
  settings.crank_zero_std = 0.003;  // as after `calibrate`: nothing is withheld because of it
  settings.level = level;
  settings.output = kind;
  settings.output_rate = rate;
  settings.hull_pitch = 0.3;  // weight along x as well
  return settings;
}

class MeanOutput : public testing::TestWithParam<std::tuple<Level, double>> {};

TEST_P(MeanOutput, LosesNoImpulseAtAnyRate) {
  const auto [level, crank_rate] = GetParam();
  const MachineSettings machine = machineAt(crank_rate);
  const Session session = simulation::recordSession(machine);
  const StampNs until = 5000000000;  // a multiple of every interval below
  const Total at_samples = sum(session, machine, settingsOf(level, OutputKind::kMean, 0.0), until);
  const double size = 500.0 * 25;  // [N s] of some 25 revolutions; the same number for the moment [N m s]
  ASSERT_NEAR(at_samples.time, 5.0, 1e-9);
  for (const double rate : {5000.0, 1000.0, 100.0, 20.0}) {
    const Total fixed = sum(session, machine, settingsOf(level, OutputKind::kMean, rate), until);
    EXPECT_EQ(fixed.outputs, static_cast<std::size_t>(5.0 * rate)) << rate;
    EXPECT_NEAR(fixed.time, at_samples.time, 1e-9) << rate;
    EXPECT_NEAR(fixed.x, at_samples.x, 1e-9 * size) << rate;
    EXPECT_NEAR(fixed.z, at_samples.z, 1e-9 * size) << rate;
    EXPECT_NEAR(fixed.about_d, at_samples.about_d, 1e-9 * size) << rate;
  }
}

INSTANTIATE_TEST_SUITE_P(LevelsAndCrankRates, MeanOutput,
                         testing::Values(std::tuple(Level::kPulse, 1000.0), std::tuple(Level::kRocker, 100.0),
                                         std::tuple(Level::kLinkage, 1000.0)));

TEST(MeanOutput, IsTheImpulseOfTheTurns) {
  const MachineSettings machine = machineAt(1000.0);
  const Session session = simulation::recordSession(machine);
  PipelineSettings settings = settingsOf(Level::kRocker, OutputKind::kMean, 20.0);
  settings.hull_pitch = 0.0;
  settings.pitch_joints.clear();
  const Total total = sum(session, machine, settings, 5000000000);
  double true_impulse = 0.0;  // trapezoidal rule over the true force
  for (std::size_t i = 1; i < session.truth.size(); ++i) {
    const auto &a = session.truth[i - 1], &b = session.truth[i];
    if (b.time > 5.0) break;
    true_impulse += 0.5 * (b.time - a.time) * (a.load.force_z + b.load.force_z);
  }
  EXPECT_GT(true_impulse, 1000.0);
  EXPECT_NEAR(total.z, true_impulse, 0.02 * true_impulse) << "the trapezoid over the blow's jump is the larger error";
}

TEST(InstantaneousOutput, LiesOnTheSamplesWhereItsOwnRateMeetsThem) {
  const MachineSettings machine = machineAt(1000.0);
  const Session session = simulation::recordSession(machine);
  Pipeline pipeline(test::mechanismOf(machine.hammer), settingsOf(Level::kRocker, OutputKind::kInstantaneous, 3000.0));
  std::size_t outputs = 0, at_samples = 0, beside = 0;
  double before = 0.0;
  for (const auto& reading : session.crank) {
    const SampleResult& loads = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    beside += !loads.refusal && !loads.isPublished();
    for (const WrenchOutput& output : loads.outputs) {
      ++outputs;
      if (output.stamp != reading.stamp) continue;
      ++at_samples;
      EXPECT_EQ(output.wrench.force_z, loads.wrench.force_z);
      before = output.wrench.force_z;
    }
  }
  EXPECT_NE(before, 0.0);
  EXPECT_EQ(at_samples + beside, session.crank.size());
  EXPECT_LE(beside, 40u) << "the crank begins at rest on the tool, and its zero shows in the second turn";
  const double expected = 3.0 * static_cast<double>(session.crank.size());
  EXPECT_LE(static_cast<double>(outputs), expected + 4.0);
  EXPECT_GT(static_cast<double>(outputs), 0.995 * expected) << "but those beside the blow";
}

TEST(MeanOutput, RestartsAfterADropOut) {
  MachineSettings machine = machineAt(1000.0);
  machine.crank.drop_outs = {{2.0, 2.5}};
  const Session session = simulation::recordSession(machine);
  const Total total = sum(session, machine, settingsOf(Level::kRocker, OutputKind::kMean, 100.0), 5000000000);
  EXPECT_LT(total.time, 4.52) << "what the gap did is not known";
  EXPECT_GT(total.time, 4.40);
}

}  // namespace
}  // namespace hammer_loads
