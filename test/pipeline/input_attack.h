/// A pipeline at work, hostile input to it, and its output meanwhile and afterwards.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/mo100.h"

namespace hammer_loads::test {

using simulation::CrankReading;
using simulation::Session;
using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
constexpr double kUndisturbedFrom = 3.0, kAttack = 4.0, kSoundFrom = 4.1, kUntil = 5.0;  // [s] of the session
constexpr double kOneTurn = 0.25;           // [s]; the machine makes some 4.6 revolutions per second
constexpr double kUndisturbedError = 0.02;  // error of Fz over its peak; undisturbed sessions stay within 0.012
inline const Names kBoom{"boom_joint", "arm_joint", "hammer_joint"};
inline const Numbers kBoomAngles{-0.35, 1.20, -0.85};

inline const simulation::MachineSettings& attackedMachine() {
  static const simulation::MachineSettings settings = [] {
    simulation::MachineSettings s = simulation::workingMo100();
    s.duration = kUntil;
    for (simulation::JointMotion& joint : s.boom) joint.amplitude = 0.0;
    return s;
  }();
  return settings;
}

inline const Session& attacked() {
  static const Session recorded = simulation::recordSession(attackedMachine());
  return recorded;
}

/// A pipeline at work and its output.
class Victim {
 public:
  explicit Victim(const PipelineSettings& settings) : pipeline_(mechanismOf(attackedMachine().hammer), settings) {
    for (const auto& truth : attacked().truth) peak_ = std::max(peak_, std::abs(truth.load.force_z));
  }

  /// Plays the good samples of [from, to) [s], or passes them to `instead`.
  void work(double from, double to, const std::function<void(const CrankReading&)>& instead = {}) {
    boom(kBoom, kBoomAngles);
    for (std::size_t i = 0; i < attacked().crank.size(); ++i) {
      const CrankReading& reading = attacked().crank[i];
      const double time = attacked().truth[i].time;
      if (time < from || time >= to) continue;
      if (instead) {
        instead(reading);
        continue;
      }
      const SampleResult& loads = crank(reading.stamp, kCrank, {reading.angle}, {*reading.speed});
      if (!loads.isPublished()) continue;
      if (first_accepted_ < from) first_accepted_ = time;
      worst_ = std::max(worst_, std::abs(loads.wrench.force_z - attacked().truth[i].load.force_z) / peak_);
    }
  }
  const SampleResult& good(const CrankReading& r) { return crank(r.stamp, kCrank, {r.angle}, {*r.speed}); }
  const SampleResult& crank(StampNs stamp, const Names& names, const Numbers& position, const Numbers& velocity) {
    const SampleResult& loads = pipeline_.crankJoint(stamp, names, position, velocity);
    if (!loads.refusal) {
      for (const double value : {loads.wrench.force_x, loads.wrench.force_z, loads.wrench.torque_y, loads.crank.speed,
                                 loads.crank.acceleration, loads.crank.position.angle.offset}) {
        finite_ = finite_ && std::isfinite(value);
      }
    }
    for (std::size_t i = 0; i < loads.turn_ends; ++i) {
      const TurnEnd& end = loads.ends[i];
      finite_ = finite_ && std::isfinite(end.blow.energy) && std::isfinite(end.blow.tool_impulse_z);
      if (end.pulse)
        finite_ = finite_ && std::isfinite(end.pulse->amplitude) && std::isfinite(end.pulse->turn_impulse_z);
    }
    return loads;
  }
  bool boom(const Names& names, const Numbers& position) { return pipeline_.boomJoints(0, names, position, {}); }

  void forgetErrors() { worst_ = 0.0; }
  bool finite() const { return finite_; }
  double firstAccepted() const { return first_accepted_; }  ///< of the last work() [s]
  double worst() const { return worst_; }                   ///< error of Fz over the peak [-]
  std::uint64_t refused(Refusal reason) const { return pipeline_.counts().refused[static_cast<std::size_t>(reason)]; }
  std::uint64_t accepted() const { return pipeline_.counts().accepted; }
  const Pipeline& pipeline() const { return pipeline_; }

 private:
  Pipeline pipeline_;
  double peak_{}, worst_{}, first_accepted_{};
  bool finite_{true};
};

inline std::vector<PipelineSettings> allSettings() {
  std::vector<PipelineSettings> all;
  const PipelineSettings shipped = loadFiles(configDirectory(), {}).value->pipeline;
  for (const auto& [name, level] : kRigidLevelNames) {
    all.push_back(shipped);
    all.back().level = level;
  }
  return all;
}

}  // namespace hammer_loads::test
