#include "hammer_loads/bench/step_costs.h"

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/make_tracker.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/pipeline/smoothed_runs.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kWorkBegins = 3.0, kWorkEnds = 8.0;  // [s]
constexpr double kOnBoomEnds = 4.0;                   // [s], from rest
constexpr double kDamping = 0.02;                     // of a coupling, of critical
constexpr simulation::RodSettings kRod{1e9, 0.2, 0.0};

/// Crank readings of a hammer at work at 1 kHz, what the level knows being there: links with masses,
/// a rod that gives. coupling_frequency [Hz]: of its shaft, 0: rigid.
std::vector<simulation::CrankReading> workingReadings(const Settings& settings, Level level,
                                                      double coupling_frequency = 0.0) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = settings.mechanism.parameters();
  machine.level = level;
  if (level == Level::kElastic) machine.level = Level::kLinkage, machine.rod = kRod;
  machine.drive.coupling_frequency = coupling_frequency;
  machine.drive.coupling_damping = kDamping;
  machine.drive.stop_time = kWorkEnds + 1.0;
  machine.duration = kWorkEnds;
  const std::vector<simulation::CrankReading> all = simulation::recordSession(machine).crank;
  std::vector<simulation::CrankReading> work;
  for (const simulation::CrankReading& reading : all) {
    if (1e-9 * static_cast<double>(reading.stamp - machine.start_stamp) >= kWorkBegins) work.push_back(reading);
  }
  return work;
}

PipelineSettings settingsOf(const Settings& settings, Level level) {
  PipelineSettings s = settings.pipeline;
  s.level = level;
  s.crank_angle_resolution = kTwoPi / 4096.0;  // the simulated encoder
  return s;
}

CostRow trackerCost(const char* name, CrankTracker& tracker, const std::vector<simulation::CrankReading>& readings) {
  const auto pass = [&] {
    tracker.start({readings.front().angle, readings.front().speed});
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const double step = 1e-9 * static_cast<double>(readings[i].stamp - readings[i - 1].stamp);
      keep(tracker.update(step, {readings[i].angle, readings[i].speed}));
      keep(tracker.estimate());
    }
  };
  return {"crank", name, costOf(readings.size(), pass), {}, {}};
}

CostRow trackerCost(const Settings& settings, const char* name, Level level) {
  const auto tracker = makeTracker(settings.mechanism, settingsOf(settings, level));
  return trackerCost(name, *tracker, workingReadings(settings, level));
}

/// coupling_frequency [Hz]: of the machine, and as given.
CostRow flexibleCost(const Settings& settings, const char* name, Level level, double coupling_frequency) {
  PipelineSettings pipeline = settingsOf(settings, level);
  pipeline.coupling = Coupling{coupling_frequency, 0.5, kDamping, 0.3, 0.03};
  const auto tracker = makeTracker(settings.mechanism, pipeline);
  return trackerCost(name, *tracker, workingReadings(settings, level, coupling_frequency));
}

/// The filter, its track and the way back: what a recording's sample costs beside the second pass.
CostRow smoothedCost(const Settings& settings, const char* name, Level level) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  const PipelineSettings pipeline = settingsOf(settings, level);
  const auto pass = [&] {
    SmoothedRuns runs;
    const auto ahead = runs.ahead()(settings.mechanism, pipeline);
    ahead->start({readings.front().angle, readings.front().speed});
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const double step = 1e-9 * static_cast<double>(readings[i].stamp - readings[i - 1].stamp);
      keep(ahead->update(step, {readings[i].angle, readings[i].speed}));
    }
  };
  return {"crank", name, costOf(readings.size(), pass), {}, {}};
}

CostRow pipelineCost(const Settings& settings, const char* name, Level level) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  Pipeline pipeline(settings.mechanism, settingsOf(settings, level));
  const auto pass = [&] {
    for (const simulation::CrankReading& r : readings) keep(pipeline.crankSample(r.stamp, {r.angle, r.speed}));
  };  // the second pass begins with time running back: one restart
  return {"pipeline", name, costOf(readings.size(), pass), {}, {}};
}

/// With the shipped boom under it, level rocker.
CostRow onBoomCost(const char* name, const simulation::Session& session, const char* keys,
                   const SensorsOnBoom& sensors) {
  const Settings settings = shippedBoom(keys);
  const auto pass = [&] {
    SessionPlayer player(settings.mechanism, settings.pipeline, settings.boom, session);
    player.imu_speaks = sensors.imu, player.pressures_speak = sensors.pressures;
    player.playTo(kInfinity, [](double, const SampleResult& result) { keep(result); });
  };
  return {"pipeline", name, costOf(session.crank.size(), pass), {}, {}};
}

/// Pipeline, turn loads and cycles of the shipped channels.
CostRow countedCost(const Settings& settings, const char* name, Level level) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  Pipeline pipeline(settings.mechanism, settingsOf(settings, level));
  LifeFollower follower(pipeline, settings.life);
  const auto pass = [&] {
    for (const simulation::CrankReading& r : readings) {
      keep(pipeline.crankSample(r.stamp, {r.angle, r.speed}));
      if (follower.due()) follower.take();
      follower.follow();
    }
  };
  return {"pipeline", name, costOf(readings.size(), pass), {}, {}};
}

}  // namespace

std::vector<CostRow> stepCosts(const Settings& settings) {
  const simulation::Session on_boom = simulation::recordSession(machineOnBoom(kOnBoomEnds));
  return {trackerCost(settings, "mechanism, rocker", Level::kRocker),
          trackerCost(settings, "mechanism, linkage", Level::kLinkage),
          flexibleCost(settings, "mechanism, linkage, flexible shaft of 50 Hz", Level::kLinkage, 50.0),
          smoothedCost(settings, "mechanism, linkage, smoothed", Level::kLinkage),
          pipelineCost(settings, "rocker", Level::kRocker),
          pipelineCost(settings, "linkage", Level::kLinkage),
          pipelineCost(settings, "elastic, a rod that gives", Level::kElastic),
          countedCost(settings, "rocker, turn loads and cycles", Level::kRocker),
          countedCost(settings, "linkage, turn loads and cycles", Level::kLinkage),
          onBoomCost("rocker, boom by its model", on_boom, "{boom: compliant, hull_motion: model}", {}),
          onBoomCost("rocker, boom, IMU and pressures", on_boom,
                     "{boom: compliant, boom_stiffness: identified, hull_motion: imu}", {true, true})};
}

}  // namespace hammer_loads::accuracy
