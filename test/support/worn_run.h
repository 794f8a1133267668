/// A worn machine through the pipeline, judged by its truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/pipeline/life_follower.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/functions.h"
#include "support/worn_machine.h"

namespace hammer_loads::test {

/// Shares of the samples within two deviations, by class of crank angle, and root mean squares of Fz [N].
struct Covered {
  static constexpr int kClasses = 6;
  static constexpr double kFrom[kClasses + 1] = {0.0, 30.0, 90.0, 180.0, 270.0, 330.0, 360.0};  // [deg]
  int count[kClasses]{}, within[kClasses][3]{};
  double error[kClasses]{}, stated[kClasses]{};
  double largest{};  // true Fz beside the contacts [N]
  int blows{}, energies{};
  int followed{}, after_blow{};            // samples of the first 90 deg with the spring; all
  life::ExactCycles true_loads;            // of Fx
  std::optional<life::CycleCount> counts;  // of Fx, with deviations

  double share(int c) const {
    return static_cast<double>(*std::min_element(within[c], within[c] + 3)) / std::max(1, count[c]);
  }
  double least() const {
    double least = 1.0;
    for (int c = 0; c < kClasses; ++c) least = std::min(least, share(c));
    return least;
  }
};

inline Covered coveredOf(const Settings& shipped, const WornMachineSettings& machine, Level level = Level::kElastic) {
  const auto [samples, blows] = WornMachine(machine).run();
  PipelineSettings settings = shipped.pipeline;
  settings.level = level;
  Pipeline pipeline(shipped.mechanism, settings);
  life::LifeSettings counted;
  counted.channels = {{"hull_wrench/force_x", *life::LoadGrid::make(-2e5, 2e5, 4096).value}};
  LifeFollower follower(pipeline, counted);
  Covered covered;
  constexpr double kLearned = 2.0, kBesideTouch = 1.5e-3;  // [s]
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& sample = samples[i];
    const auto stamp = static_cast<StampNs>(std::llround(1e9 * (100.0 + sample.time)));
    const SampleResult& result = pipeline.crankSample(stamp, {sample.reading, std::nullopt});
    if (sample.time < kLearned) continue;
    follower.follow();
    if (sample.since_touch > kBesideTouch) covered.true_loads.add(sample.force_x);
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const double time = 1e-9 * static_cast<double>(result.ends[k].stamp) - 100.0;
      for (const auto& blow : blows) {
        if (std::abs(blow.time - time) > 0.02) continue;
        ++covered.blows;
        covered.energies += std::abs(result.ends[k].blow.energy - blow.energy) <= 2.0 * result.ends[k].blow.energy_std;
      }
    }
    const bool touches =
        sample.since_touch < kBesideTouch || (i + 1 < samples.size() && samples[i + 1].since_touch < kBesideTouch);
    if (!result.isPublished() || touches) continue;
    const double degrees = std::fmod(sample.reading, kTwoPi) / kDegree;
    int c = 0;
    while (c + 1 < Covered::kClasses && degrees >= Covered::kFrom[c + 1]) ++c;
    const double drive = driveReaction(pipeline.model(), pipeline.crank().tracker().driveInertia())
                             .torque(result.crank.acceleration, 0.0);
    const double errors[] = {result.wrench.force_x - sample.force_x, result.wrench.force_z - sample.force_z,
                             result.wrench.torque_y - drive - sample.torque_y};
    const Eigen::Vector3d stated = vectorOf(result.deviation.wrench());
    ++covered.count[c];
    covered.largest = std::max(covered.largest, std::abs(sample.force_z));
    if (c < 2) ++covered.after_blow, covered.followed += result.rod_followed;
    for (int k = 0; k < 3; ++k) covered.within[c][k] += std::abs(errors[k]) <= 2.0 * stated[k];
    covered.error[c] += square(errors[1]), covered.stated[c] += square(stated[1]);
  }
  covered.counts = follower.take().counts[0];
  return covered;
}

/// The hammer of the settings with other masses.
inline WornMachineSettings wornMo100(const Settings& shipped) {
  WornMachineSettings machine;
  machine.hammer = shipped.mechanism.parameters();
  machine.hammer.rocker_mass *= 1.02, machine.hammer.rocker_inertia_about_pivot *= 0.98;
  return machine;
}

}  // namespace hammer_loads::test
