// Faults of the crank's sensor during work: accepted samples stay accurate, during the fault and after it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/exact_hammer.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using simulation::Session;

constexpr double kFaultFrom = 2.4,
                 kCountedTo = 3.0;   // [s] faults begin within a revolution from kFaultFrom; errors count to kCountedTo
constexpr double kTurn = 0.22;       // [s]
constexpr double kGoodError = 0.02;  // error of Fz over its peak: undisturbed sessions stay within 0.012

/// Changes the sample at a time [s].
using Fault = std::function<void(double, CrankSample&)>;

Session record(double rate) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.drive.start_time = 0.1;
  machine.duration = kCountedTo + 0.4;
  machine.crank.rate = rate;
  for (simulation::JointMotion& joint : machine.boom) joint.amplitude = 0.0;
  return simulation::recordSession(machine);
}

struct Result {
  double worst{};          ///< error of Fz over its peak, accepted samples from kFaultFrom to kCountedTo
  std::uint64_t lost{};    ///< samples not accepted in the meantime
  std::uint64_t faulty{};  ///< samples that the fault changed
};

Result play(const Session& session, const Fault& fault) {
  static const Settings settings = test::withExactHammer(*loadFiles(configDirectory(), {}).value);
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  pipeline.boomJoints(0, {"boom_joint", "arm_joint", "hammer_joint"}, {-0.35, 1.20, -0.85}, {});
  Result result;
  double peak = 0.0;
  for (const auto& truth : session.truth) peak = std::max(peak, std::abs(truth.load.force_z));
  for (std::size_t i = 0; i < session.crank.size() && session.truth[i].time < kCountedTo; ++i) {
    const CrankSample good{session.crank[i].angle, session.crank[i].speed};
    CrankSample sample = good;
    fault(session.truth[i].time, sample);
    result.faulty += sample.angle != good.angle || sample.speed != good.speed;
    const SampleResult& loads = pipeline.crankSample(session.crank[i].stamp, sample);
    if (session.truth[i].time < kFaultFrom) continue;
    result.lost += loads.refusal.has_value();
    if (loads.refusal) continue;
    result.worst = std::max(result.worst, std::abs(loads.wrench.force_z - session.truth[i].load.force_z) / peak);
  }
  return result;
}

/// Calls `at` with instants all over a revolution, in steps that divide no period of the machine.
void everywhere(const std::function<void(double)>& at) {
  for (double begin = kFaultFrom; begin < kFaultFrom + kTurn; begin += 0.0203) at(begin);
}

TEST(SensorFault, CausesNoLargeErrorForAnAngleThatStandsStillWhileTheSpeedGoesOn) {
  for (const double rate : {1000.0, 200.0}) {
    const Session session = record(rate);
    for (const double length : {0.003, 0.02, 0.1}) {
      everywhere([&](double begin) {
        std::optional<double> held;
        const Result result = play(session, [&](double time, CrankSample& sample) {
          if (time < begin || time >= begin + length) return;
          if (!held) held = sample.angle;
          sample.angle = *held;
        });
        EXPECT_LE(result.worst, kGoodError) << rate << " Hz, " << length << " s from " << begin;
        EXPECT_LE(result.lost, result.faulty + 2) << rate << " Hz, " << length << " s from " << begin;
      });
    }
  }
}

/// An angle is far off beyond a third of the way between two samples of the fastest crank here, 0.052 rad.
TEST(SensorFault, LosesOneSampleToAnAngleFarOff) {
  const Session session = record(1000.0);
  for (const bool with_speed : {true, false}) {
    for (const double off : {0.03, 0.1, -0.05, -0.3}) {
      everywhere([&](double begin) {
        bool done = false;
        const Result result = play(session, [&](double time, CrankSample& sample) {
          if (!with_speed) sample.speed.reset();
          if (time < begin || done) return;
          sample.angle = std::fmod(sample.angle + off + kTwoPi, kTwoPi);
          done = true;
        });
        EXPECT_LE(result.worst, kGoodError) << off << " rad at " << begin;
        EXPECT_EQ(result.lost, 1u) << off << " rad at " << begin;
      });
    }
  }
}

TEST(SensorFault, LosesNoSampleToASpeedWithoutInformation) {
  for (const double rate : {1000.0, 100.0, 50.0}) {
    const Session session = record(rate);
    for (const double factor : {0.0, 1.3}) {
      const Result result = play(session, [&](double, CrankSample& sample) { sample.speed = factor * *sample.speed; });
      EXPECT_LE(result.worst, kGoodError) << factor << " times the speed at " << rate << " Hz";
      EXPECT_EQ(result.lost, 0u) << factor << " times the speed at " << rate << " Hz";
    }
  }
}

}  // namespace
}  // namespace hammer_loads
