// Costs of one state, one sample and one pose by google-benchmark; scripts/update_performance writes them to
// doc/performance.md.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>

#include "hammer_loads/bench/boom_errors.h"
#include "hammer_loads/grapple/branches.h"
#include "hammer_loads/grapple/grapple_settings.h"
#include "hammer_loads/grapple/grapple_tracker.h"
#include "hammer_loads/hammer/batch.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/pipeline/filter_settings.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/settings/load.h"
#include "support/printed_formulas.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kStates = 1024;  // all arrays of a batch stay in the second-level cache
constexpr double kSpeed = 31.416, kAcceleration = 50.0;
const Gravity kGravity{2.9, -9.37};

template <typename Pass>
void add(const std::string& name, std::size_t evaluations, Pass pass) {
  benchmark::RegisterBenchmark(name.c_str(), [evaluations, pass = std::move(pass)](benchmark::State& state) mutable {
    for (auto _ : state) pass();
    state.SetItemsProcessed(static_cast<std::int64_t>(evaluations) * state.iterations());
  });
}

Settings shipped() { return *load(configDirectory(), {}).value; }

/// Returns evenly spaced angles of a revolution, none at the blow [rad].
std::vector<double> turn() {
  std::vector<double> angles;
  for (std::size_t i = 0; i < kStates; ++i) angles.push_back(kTwoPi * (static_cast<double>(i) + 0.5) / kStates);
  return angles;
}

void addScalarLoads(const Mechanism& mechanism) {
  std::vector<CrankMotion> cranks;
  for (const double angle : turn()) cranks.push_back({CrankAngle::fromAngle(angle), kSpeed, kAcceleration});
  add("printed/P0 with inverse trigonometry", kStates,
      [formulas = test::PrintedFormulas(mechanism.parameters(), test::Positions::kInverseTrigonometry),
       angles = turn()] {
        for (const double angle : angles) benchmark::DoNotOptimize(formulas(angle, kSpeed, kAcceleration, kGravity));
      });
  for (const auto& [name, level] :
       {std::pair{"pulse", Level::kPulse}, {"rocker", Level::kRocker}, {"linkage", Level::kLinkage}}) {
    add(std::string("scalar/") + name, kStates, [model = HullModel(mechanism, level), cranks] {
      for (const CrankMotion& crank : cranks) benchmark::DoNotOptimize(hullWrench(model, crank, kGravity));
    });
  }
  add("scalar/linkage with pins", kStates, [mechanism, cranks] {
    const NearBlow near_blow(0.01);
    for (const CrankMotion& crank : cranks) {
      const LinkMotion links = linkMotion(mechanism.linkage(), crank.angle);
      benchmark::DoNotOptimize(hullWrench(mechanism, links, crank, kGravity));
      benchmark::DoNotOptimize(pinForces(mechanism, Level::kLinkage, links, crank, kGravity, near_blow));
    }
  });
}

void addBatch(const Mechanism& mechanism, const char* name, Level level) {
  add(std::string("batch/") + name, kStates,
      [model = HullModel(mechanism, level), angles = turn(), speeds = std::vector<double>(kStates, kSpeed),
       accelerations = std::vector<double>(kStates, kAcceleration),
       out = std::array<std::vector<double>, 3>{turn(), turn(), turn()}]() mutable {
        hullWrenches(model, {angles.data(), speeds.data(), accelerations.data(), kStates}, kGravity,
                     {out[0].data(), out[1].data(), out[2].data()});
        benchmark::ClobberMemory();
      });
}

/// Returns 1 kHz readings of a working hammer with what the level models: links with masses, an elastic rod.
std::vector<simulation::CrankReading> workingReadings(const Settings& settings, Level level) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = settings.mechanism.parameters();
  machine.level = level;
  if (level == Level::kElastic) machine.level = Level::kLinkage, machine.rod = {1e9, 0.2, 0.0};
  machine.drive.stop_time = 9.0, machine.duration = 8.0;
  std::vector<simulation::CrankReading> work;
  for (const simulation::CrankReading& reading : simulation::recordSession(machine).crank)
    if (1e-9 * static_cast<double>(reading.stamp - machine.start_stamp) >= 3.0) work.push_back(reading);
  return work;
}

PipelineSettings withLevel(PipelineSettings settings, Level level) {
  settings.level = level;
  settings.crank_angle_resolution = kTwoPi / 4096.0;  // the simulated encoder
  return settings;
}

void addFilter(const Settings& settings, const char* name, Level level) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  const CrankFilter fresh(ShaftModel(settings.mechanism, level), settings.mechanism.parameters().drive_inertia,
                          filterSettings(settings.mechanism, withLevel(settings.pipeline, level)));
  add(name, readings.size(), [filter = fresh, readings]() mutable {
    filter.start({readings.front().angle, readings.front().speed});
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const double step = 1e-9 * static_cast<double>(readings[i].stamp - readings[i - 1].stamp);
      benchmark::DoNotOptimize(filter.update(step, {readings[i].angle, readings[i].speed}));
      benchmark::DoNotOptimize(filter.estimate());
    }
  });
}

/// Adds the cost of a pipeline; counts: with revolution loads and cycles of the shipped channels.
void addPipeline(const Settings& settings, const char* name, Level level, bool counts = false) {
  const std::vector<simulation::CrankReading> readings = workingReadings(settings, level);
  const auto pipeline = std::make_shared<Pipeline>(settings.mechanism, withLevel(settings.pipeline, level));
  const auto follower = counts ? std::make_shared<LifeFollower>(*pipeline, settings.life) : nullptr;
  add(name, readings.size(), [=] {  // the second pass begins with time running back: one restart
    for (const simulation::CrankReading& r : readings) {
      benchmark::DoNotOptimize(pipeline->crankSample(r.stamp, {r.angle, r.speed}));
      if (follower == nullptr) continue;
      if (follower->due()) follower->take();
      follower->follow();
    }
  });
}

/// Adds the cost of a pipeline on the shipped boom at level rocker.
void addOnBoom(const simulation::Session& session, const char* name, const char* keys, bool sensors) {
  add(name, session.crank.size(), [settings = accuracy::shippedBoom(keys), session, sensors] {
    accuracy::SessionPlayer player(settings.mechanism, settings.pipeline, settings.boom, session);
    player.imu_speaks = player.pressures_speak = sensors;
    player.playTo(kInfinity, [](double, const SampleResult& result) { benchmark::DoNotOptimize(&result); });
  });
}

constexpr std::size_t kSamples = 100000, kChannels = 20, kSamplesOfTurn = 200;
constexpr double kScale = 200000.0;  // [N]

/// Returns a load of one pulse per revolution, with noise of a thousandth of the scale.
std::vector<double> hammerLoad() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1e-3 * kScale);
  std::vector<double> values;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double phase = static_cast<double>(i % kSamplesOfTurn) / kSamplesOfTurn;
    values.push_back(0.2 * kScale * std::pow(std::sin(0.5 * kTwoPi * phase), 15) + noise(random));
  }
  return values;
}

void addLife() {
  const life::LoadGrid grid = life::LoadGrid::make(-kScale, kScale, 4096).value.value();
  const std::vector<double> values = hammerLoad();
  add("life/cycle counter", kSamples, [counter = std::make_shared<life::CycleCounter>(grid), values] {
    for (const double value : values) counter->add(value);
    benchmark::DoNotOptimize(counter->tally().counted);
  });
  life::LifeSettings settings;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kChannels; ++i) {
    names.push_back("channel_" + std::to_string(i));
    settings.channels.push_back({names.back(), grid});
  }
  settings.period = INT64_MAX;
  add("life/20 channels with deviations, each", (kSamples - kChannels) * kChannels,
      [recorder = std::make_shared<life::LifeRecorder>(settings, names), values,
       deviations = std::vector<double>(kChannels, 100.0), stamp = std::int64_t{0}]() mutable {
        for (std::size_t i = 0; i + kChannels < values.size(); ++i)
          recorder->sample(stamp += 1000000, &values[i], deviations.data());
      });
}

void addGrapple() {
  const Grapple grapple = *loadGrapple({configDirectory() + "/grapple_claims.yaml"}).value;
  const GrappleParameters& p = grapple.parameters();
  std::vector<double> sliders;  // one swing over the stroke and back: 2 s at 1 kHz
  for (int i = 0; i < 2000; ++i)
    sliders.push_back(0.5 * (p.slider_closed + p.slider_open) +
                      0.5 * (p.slider_open - p.slider_closed) * std::cos(kTwoPi * i / 2000.0));
  add("grapple/warm step, both jaws", sliders.size(), [tracker = GrappleTracker(grapple), sliders]() mutable {
    for (const double slider : sliders) {
      tracker.update({slider, 0.3, -0.2});
      benchmark::DoNotOptimize(tracker.right());
      benchmark::DoNotOptimize(tracker.left());
    }
  });
  add("grapple/cold pose", sliders.size(), [grapple, sliders] {
    for (const double slider : sliders) benchmark::DoNotOptimize(grapple.at(slider));
  });
}

void addAll() {
  const Settings settings = shipped();
  addScalarLoads(settings.mechanism);
  addBatch(settings.mechanism, "rocker", Level::kRocker);
  addBatch(settings.mechanism, "linkage", Level::kLinkage);
  addFilter(settings, "crank/rocker", Level::kRocker);
  addFilter(settings, "crank/linkage", Level::kLinkage);
  addPipeline(settings, "pipeline/rocker", Level::kRocker);
  addPipeline(settings, "pipeline/linkage", Level::kLinkage);
  addPipeline(settings, "pipeline/elastic", Level::kElastic);
  addPipeline(settings, "pipeline/linkage, turn loads and cycles", Level::kLinkage, true);
  const simulation::Session on_boom = simulation::recordSession(accuracy::machineOnBoom(4.0));
  addOnBoom(on_boom, "pipeline/rocker, boom by its model", "{boom: compliant, hull_motion: model}", false);
  addOnBoom(on_boom, "pipeline/rocker, boom, IMU and pressures",
            "{boom: compliant, boom_stiffness: identified, hull_motion: imu}", true);
  addLife();
  addGrapple();
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  hammer_loads::addAll();
  benchmark::RunSpecifiedBenchmarks();
}
