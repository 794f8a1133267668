#include "hammer_loads/bench/life_costs.h"

#include <cmath>
#include <random>
#include <string>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/turn_loads.h"

namespace hammer_loads::accuracy {
namespace {

constexpr std::size_t kSamples = 100000;
constexpr std::size_t kChannels = 20;
constexpr std::size_t kSamplesOfTurn = 200;  // 5 turns/s at 1 kHz
constexpr double kScale = 200000.0;          // [N]

life::LoadGrid grid() { return life::LoadGrid::make(-kScale, kScale, 4096).value.value(); }

/// A pulse a turn with noise of a thousandth of the scale.
std::vector<double> hammerLoad() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1e-3 * kScale);
  std::vector<double> values;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double phase = static_cast<double>(i % kSamplesOfTurn) / kSamplesOfTurn;
    values.push_back(0.2 * kScale * std::pow(std::sin(3.14159265358979 * phase), 15) + noise(random));
  }
  return values;
}

std::vector<double> noise() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-kScale, kScale);
  std::vector<double> values(kSamples);
  for (double& v : values) v = value(random);
  return values;
}

CostRow counterCost(const char* name, const std::vector<double>& values) {
  life::CycleCounter counter(grid());
  return {"life",
          name,
          costOf(values.size(),
                 [&] {
                   for (const double value : values) counter.add(value);
                   keep(counter.residue());
                 }),
          {},
          {}};
}

CostRow recorderCost(const std::vector<double>& values) {
  life::LifeSettings settings;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kChannels; ++i) {
    names.push_back("channel_" + std::to_string(i));
    settings.channels.push_back({names.back(), grid()});
  }
  settings.period = INT64_MAX;
  life::LifeRecorder recorder = life::LifeRecorder::make(settings, names).value.value();
  std::int64_t stamp = 0;
  const std::vector<double> deviations(kChannels, 100.0);
  return {"life",
          "20 channels with deviations, each",
          costOf((values.size() - kChannels) * kChannels,
                 [&] {
                   for (std::size_t i = 0; i + kChannels < values.size(); ++i)
                     recorder.sample(stamp += 1000000, &values[i], deviations.data());
                 }),
          {},
          {}};
}

CostRow turnCost(const std::vector<double>& values) {
  life::TurnLoadsRecorder recorder(kChannels);
  std::int64_t stamp = 0;
  return {"life",
          "turn loads of 20 channels, each",
          costOf((values.size() - kChannels) * kChannels,
                 [&] {
                   for (std::size_t i = 0; i + kChannels < values.size(); ++i) {
                     recorder.add(stamp += 1000000, &values[i]);
                     if (i % kSamplesOfTurn == 0) keep(recorder.endTurn(stamp));
                   }
                 }),
          {},
          {}};
}

}  // namespace

std::vector<CostRow> lifeCosts() {
  const std::vector<double> load = hammerLoad();
  return {counterCost("cycle counter, hammer at work", load),
          counterCost("cycle counter, noise over the scale", noise()), recorderCost(load), turnCost(load)};
}

}  // namespace hammer_loads::accuracy
