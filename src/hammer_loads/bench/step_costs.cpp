#include "hammer_loads/bench/step_costs.h"

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/pipeline/filter_settings.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {
namespace {

constexpr double kWorkBegins = 3.0, kWorkEnds = 8.0;  // [s]
constexpr double kOnBoomEnds = 4.0;                   // [s], from rest
constexpr simulation::RodSettings kRod{1e9, 0.2, 0.0};

/// Crank readings of a hammer at work at 1 kHz, what the level knows being there: links with masses,
/// a rod that gives.
std::vector<simulation::CrankReading> workingReadings(const Settings& settings, Level level) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = settings.mechanism.parameters();
  machine.level = level;
  if (level == Level::kElastic) machine.level = Level::kLinkage, machine.rod = kRod;
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

CostRow filterCost(const Settings& settings, const char* name, Level level) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  CrankFilter filter(ShaftModel(settings.mechanism, level), settings.mechanism.parameters().drive_inertia,
                     filterSettings(settings.mechanism, settingsOf(settings, level)));
  const auto pass = [&] {
    filter.start({readings.front().angle, readings.front().speed});
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const double step = 1e-9 * static_cast<double>(readings[i].stamp - readings[i - 1].stamp);
      keep(filter.update(step, {readings[i].angle, readings[i].speed}));
      keep(filter.estimate());
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
  return {filterCost(settings, "mechanism, rocker", Level::kRocker),
          filterCost(settings, "mechanism, linkage", Level::kLinkage),
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
