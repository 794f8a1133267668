/// The case of the papers: constant crank speed, whatever torque it needs. The truth is the wrench of the links alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/util/constants.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

constexpr int kSteadyCounts = 4096;
constexpr double kSteadyJitter = 3e-5, kSteadySpeedNoise = 0.15;  // [s], [rad/s]

struct SteadyPlayed {
  std::size_t samples{}, published{};
  Eigen::Vector3d published_peak{Eigen::Vector3d::Zero()}, true_peak{published_peak};
  double pulse{};                                ///< largest amplitude [N]
  double least_energy{1e9}, most_energy_part{};  ///< [J]; part of the rocker's kinetic energy [-]
  double least_restitution{0.0}, most_restitution{};
};

SteadyPlayed playSteady(const std::string& level, double speed, double rate, double duration) {
  const Settings settings = test::settingsWith("level: " + level + "\n");
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  const HullModel model(settings.mechanism, level == "elastic" ? Level::kLinkage : settings.pipeline.level);
  const double inertia = settings.mechanism.parameters().rocker_inertia_about_pivot;
  simulation::NormalNoise noise(3);
  SteadyPlayed played;
  for (double t = 0.0; t < duration; t += 1.0 / rate) {
    const double time = t + kSteadyJitter * noise(), angle = 1.0 + speed * time;
    const double counts = std::floor(std::fmod(angle, kTwoPi) / kTwoPi * kSteadyCounts);
    const auto stamp = static_cast<StampNs>(1'700'000'000e9 + 1e9 * time);
    const SampleResult& result =
        pipeline.crankSample(stamp, {counts * kTwoPi / kSteadyCounts, speed + kSteadySpeedNoise * noise()});
    played.samples += 2.0 * t > duration;
    const HullWrench is = hullWrench(model, driveReaction(model, 0.0), {CrankAngle::fromAngle(angle), speed, 0.0},
                                     pipeline.hull().motion().motion);
    played.true_peak = played.true_peak.cwiseMax(vectorOf(is).cwiseAbs());
    for (std::size_t i = 0; i < result.turn_ends; ++i) {
      const TurnEnd& end = result.ends[i];
      if (end.pulse) played.pulse = std::max(played.pulse, end.pulse->amplitude);
      const double had = 0.5 * inertia * end.blow.rocker_speed_before * end.blow.rocker_speed_before;
      if (std::isfinite(end.blow.energy)) {
        played.least_energy = std::min(played.least_energy, end.blow.energy);
        played.most_energy_part = std::max(played.most_energy_part, end.blow.energy / had);
      }
      if (!std::isfinite(end.blow.restitution)) continue;
      played.least_restitution = std::min(played.least_restitution, end.blow.restitution);
      played.most_restitution = std::max(played.most_restitution, end.blow.restitution);
    }
    if (result.refusal || result.outputs.empty()) continue;
    played.published += 2.0 * t > duration;
    played.published_peak = played.published_peak.cwiseMax(vectorOf(result.outputs.front().wrench).cwiseAbs());
  }
  return played;
}

TEST(ConstantSpeed, PublishesNothingAboveTheTruePeakAtAnyLevel) {
  for (const std::string level : {"rocker", "linkage", "elastic"}) {
    for (const double speed : {10.0, 14.0, 31.416, 60.0, 200.0}) {
      const SteadyPlayed played = playSteady(level, speed, 1000.0, 6.0);
      for (int i = 0; i < 2; ++i)
        EXPECT_LE(played.published_peak[i], 1.05 * played.true_peak[i]) << level << ", " << speed << " rad/s, " << i;
      EXPECT_LE(played.pulse, 1.05 * played.true_peak[1]) << level << ", " << speed << " rad/s";
      EXPECT_GE(played.least_energy, 0.0) << level << ", " << speed << " rad/s";
      EXPECT_GE(played.least_restitution, 0.0) << level << ", " << speed << " rad/s";
      EXPECT_LE(played.most_restitution, 1.0) << level << ", " << speed << " rad/s";
      if (speed < 100.0) {
        EXPECT_GT(2 * played.published, played.samples) << level << ", " << speed << " rad/s";
      }
    }
  }
}

TEST(ConstantSpeed, PublishesNothingAboveTheTruePeakAtAnyRate) {
  for (const double rate : {100.0, 5000.0}) {
    const SteadyPlayed played = playSteady("elastic", 31.416, rate, 4.0);
    for (int i = 0; i < 2; ++i) EXPECT_LE(played.published_peak[i], 1.05 * played.true_peak[i]) << rate << " Hz, " << i;
    EXPECT_LE(played.pulse, 1.05 * played.true_peak[1]) << rate << " Hz";
  }
}

}  // namespace
}  // namespace hammer_loads
