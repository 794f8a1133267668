// The smoothed crank against the live filter's, by the truth of simulated machines.
#include "hammer_loads/pipeline/smoothed_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using simulation::MachineSettings;
using simulation::Session;

constexpr double kNearBlow = 5e-4;   // [s]: which side a sample is on may stay unknown
constexpr double kJudgedFrom = 3.0;  // [s]: the filter has learned by then

struct Judged {
  double rms{};          ///< of force_z, part of the peak
  double rms_far{};      ///< the same without the samples next to a blow
  double inside{};       ///< part of the errors within two deviations
  double restitution{};  ///< rms of its error
  SampleCounts counts;
  std::vector<double> forces;  ///< force_z of every accepted sample [N]
};

MachineSettings machineOf(double rate, std::uint64_t seed, double duration = 14.0) {
  MachineSettings machine = simulation::workingMo100();
  machine.duration = duration;
  machine.drive.stop_time = duration - 0.5;
  machine.crank.rate = rate;
  machine.crank.drop_outs.clear();
  machine.seed = seed;
  return machine;
}

/// 1024 counts, no speeds, stamps of a PC, blows that differ.
MachineSettings typicalMachine(double rate, std::uint64_t seed, double duration = 14.0) {
  MachineSettings machine = machineOf(rate, seed, duration);
  machine.crank.counts = 1024;
  machine.crank.speed = false;
  machine.crank.stamp_noise = 3e-4;
  machine.blow.restitution_drawn = true;
  machine.blow.restitution_low = 0.1;
  machine.blow.restitution_high = 0.25;
  return machine;
}

void feed(const Session& session, Pipeline& pipeline, const std::function<void(std::size_t)>& sample) {
  const std::vector<std::string> names(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
  std::size_t joints = 0;
  for (std::size_t i = 0; i < session.crank.size(); ++i) {
    for (; joints < session.joints.size() && session.joints[joints].stamp <= session.crank[i].stamp; ++joints) {
      const auto& position = session.joints[joints].position;
      pipeline.boomJoints(session.joints[joints].stamp, names, {position.begin(), position.end()}, {});
    }
    pipeline.crankSample(session.crank[i].stamp, {session.crank[i].angle, session.crank[i].speed});
    sample(i);
  }
}

/// What the pipeline gave at an instant.
struct Given {
  double time{}, force_z{}, deviation{};  ///< [s since start], [N]
};

/// Of what was given while the hammer worked, by the truth at the published stamps.
void judgeForces(const MachineSettings& machine, const std::vector<Given>& given, const Session& session,
                 Judged& judged) {
  std::vector<double> times;
  for (const Given& sample : given) times.push_back(sample.time);
  const std::vector<simulation::CrankTruth> truth = simulation::truthAt(machine, times);
  double squares = 0.0, peak = 0.0, count = 0.0, far_squares = 0.0;
  auto blow = session.blows.begin();
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double error = given[i].force_z - truth[i].load.force_z;
    while (blow != session.blows.end() && blow->time < given[i].time - kNearBlow) ++blow;
    const bool near_blow = blow != session.blows.end() && blow->time < given[i].time + kNearBlow;
    peak = std::max(peak, std::abs(truth[i].load.force_z));
    judged.inside += std::abs(error) <= 2.0 * given[i].deviation;
    squares += error * error;
    if (!near_blow) far_squares += error * error;
    ++count;
  }
  judged.rms = std::sqrt(squares / count) / peak;
  judged.rms_far = std::sqrt(far_squares / count) / peak;
  judged.inside /= count;
}

/// What the pipeline takes the machine for.
struct TakenFor {
  Level level{Level::kLinkage};
  std::optional<Coupling> coupling;
};

Judged judge(const MachineSettings& machine, const Session& session, const TrackerMaker& make,
             const TakenFor& machine_is = {}) {
  Settings settings = *loadFiles(configDirectory(), {}).value;
  settings.pipeline.level = machine_is.level;
  settings.pipeline.coupling = machine_is.coupling;
  Pipeline pipeline(test::mechanismOf(machine.hammer), settings.pipeline, {}, {}, make);
  Judged judged;
  std::vector<Given> given;
  double blow_squares = 0.0, blows = 0.0;
  feed(session, pipeline, [&](std::size_t) {
    const SampleResult& result = pipeline.result();
    const auto since = [&](StampNs stamp) { return 1e-9 * static_cast<double>(stamp - machine.start_stamp); };
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const double at = since(result.ends[k].stamp);
      const auto truth = std::find_if(session.blows.begin(), session.blows.end(),
                                      [&](const auto& blow) { return std::abs(blow.time - at) < 0.02; });
      if (at < kJudgedFrom || truth == session.blows.end()) continue;
      const double true_restitution = -truth->strike.rocker_speed_after / truth->strike.rocker_speed_before;
      blow_squares += std::pow(result.ends[k].blow.restitution - true_restitution, 2);
      ++blows;
    }
    if (result.refusal || result.beside_blow) return;
    judged.forces.push_back(result.wrench.force_z);
    const double time = since(result.stamp);
    if (time < kJudgedFrom || time > machine.drive.stop_time - 0.3) return;
    given.push_back({time, result.wrench.force_z, result.outputs.back().deviation.wrench.force_z});
  });
  judgeForces(machine, given, session, judged);
  judged.restitution = std::sqrt(blow_squares / blows);
  judged.counts = pipeline.counts();
  return judged;
}

struct Both {
  Judged live, smoothed;
};

Both bothOf(const MachineSettings& machine, const TakenFor& machine_is = {}) {
  const Session session = simulation::recordSession(machine);
  SmoothedRuns runs;
  Both both{judge(machine, session, runs.ahead(), machine_is), {}};
  EXPECT_TRUE(runs.isReady());
  runs.end();
  both.smoothed = judge(machine, session, runs.behind(), machine_is);
  const auto say = [](const std::string& name, const Judged& judged) {
    testing::Test::RecordProperty(name + "_rms", std::to_string(judged.rms));
    testing::Test::RecordProperty(name + "_inside", std::to_string(judged.inside));
  };
  say("live", both.live);
  say("smoothed", both.smoothed);
  return both;
}

/// part: of the live filter's rms that is left at most.
void expectCloser(const Both& both, double part) {
  EXPECT_LT(both.smoothed.rms, both.live.rms);
  EXPECT_LT(both.smoothed.rms_far, part * both.live.rms_far);
  EXPECT_GE(both.smoothed.inside, 0.88);
  EXPECT_EQ(both.smoothed.counts.refusedTotal(), both.live.counts.refusedTotal());
}

void expectBetter(const Both& both, double part) {
  expectCloser(both, part);
  EXPECT_LE(both.smoothed.inside, 0.99);
}

TEST(SmoothedRuns, PassAheadIsTheLiveFilterBitForBit) {
  const MachineSettings machine = typicalMachine(500.0, 3);
  const Session session = simulation::recordSession(machine);
  SmoothedRuns runs;
  const Judged ahead = judge(machine, session, runs.ahead()), live = judge(machine, session, makeTracker);
  ASSERT_GT(live.forces.size(), 5000U);
  EXPECT_TRUE(ahead.forces == live.forces);
}

TEST(SmoothedRuns, NothingIsLostOnExactSensors) {
  for (const double rate : {1000.0, 100.0}) {
    const Both both = bothOf(machineOf(rate, 5));
    expectBetter(both, 0.7);
  }
}

/// The ring is that of the live filter's samples, not of those that come later; a level without it is off by ten times
/// as much.
TEST(SmoothedRuns, ARodThatGivesRingsAsLive) {
  MachineSettings machine = machineOf(1000.0, 13);
  machine.hammer = loadFiles(configDirectory(), {}).value->mechanism.parameters();
  machine.level = Level::kLinkage;
  machine.rod = {8e8, 0.3, 0.0};
  const Both both = bothOf(machine, {Level::kElastic, {}});
  EXPECT_LT(both.smoothed.rms, 1.1 * both.live.rms);
  EXPECT_GT(both.smoothed.inside, 0.88);
  EXPECT_LT(3.0 * both.smoothed.rms, bothOf(machine).smoothed.rms);
}

/// The encoder sits on the motor, beyond a coupling whose frequency is a fifth off.
TEST(SmoothedRuns, BeyondAFlexibleCouplingAsWell) {
  std::uint64_t seed = 17;
  for (const double frequency : {30.0, 50.0, 80.0}) {
    for (const double rate : {1000.0, 200.0}) {
      SCOPED_TRACE(testing::Message() << frequency << " Hz at " << rate << " Hz");
      MachineSettings machine = machineOf(rate, ++seed);
      machine.drive.coupling_frequency = frequency;
      machine.drive.motor_share = 0.3;
      machine.drive.coupling_damping = 0.02;
      const Both both = bothOf(machine, {Level::kLinkage, Coupling{1.2 * frequency, 0.3, 0.02, 0.3, 0.03}});
      expectCloser(both, 0.85);
      EXPECT_LT(both.smoothed.restitution, 1.1 * both.live.restitution);
    }
  }
}

TEST(SmoothedRuns, StampsThatJitterWeighLess) {
  double inside = 0.0;
  for (const unsigned seed : {7U, 8U, 9U, 10U}) {
    MachineSettings machine = machineOf(1000.0, seed);
    machine.crank.stamp_noise = 2e-4;
    const Both both = bothOf(machine);
    expectCloser(both, 0.8);
    EXPECT_LT(both.smoothed.rms, 0.8 * both.live.rms) << seed;
    inside += both.smoothed.inside / 4.0;
  }
  // With right speeds the errors are 0.09 % of the peak, the deviations half as large again: those of any supply.
  EXPECT_GE(inside, 0.95);
  EXPECT_LT(inside, 0.999);
}

TEST(SmoothedRuns, ATypicalMachineIsCloser) {
  for (const MachineSettings& machine : {typicalMachine(1000.0, 11), typicalMachine(200.0, 11, 45.0)}) {
    const Both both = bothOf(machine);  // 45 s: more than is smoothed at once
    expectBetter(both, 0.7);
    EXPECT_LT(both.smoothed.restitution, 1.05 * both.live.restitution);
  }
}

}  // namespace
}  // namespace hammer_loads
