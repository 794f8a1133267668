/// A machine drawn at random whose encoder has a wrong zero, and the wrenches that the pipeline publishes of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "support/session_player.h"

namespace hammer_loads::test {

constexpr double kImpossibleError = 6.0;  ///< standard deviations
constexpr double kNearTouch = 1.0e-3;     ///< [s]: the contact force is not part of the wrench

struct DrawnMachine {
  simulation::MachineSettings machine;
  bool elastic{};  ///< else with a rigid connecting rod
};

/// Rates, counts, speeds, supply, drive inertia, blow, angle at the start and connecting rod are drawn. zero: largest
/// error of the encoder's zero, in either direction [rad].
inline DrawnMachine drawMachine(const Settings& nominal, std::uint64_t seed, double zero, double duration) {
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
  };
  const auto oneOf = [&](auto... values) {
    const double all[] = {static_cast<double>(values)...};
    return all[std::min(std::size(all) - 1, static_cast<std::size_t>(between(0.0, std::size(all))))];
  };
  DrawnMachine drawn{simulation::workingMo100(), between(0.0, 1.0) < 0.5};
  simulation::MachineSettings& m = drawn.machine;
  m.hammer = nominal.mechanism.parameters();
  m.level = Level::kLinkage;
  m.seed = seed;
  m.duration = duration;
  m.start_angle = between(0.3, 5.9);
  m.crank.rate = oneOf(100.0, 200.0, 200.0, 500.0, 1000.0);
  m.crank.counts = static_cast<int>(oneOf(0, 720, 1024, 4096, 4096, 20000));
  m.crank.jitter = oneOf(0.0, 3e-5, 1e-4);
  m.crank.zero = zero * between(-1.0, 1.0);
  m.crank.speed = between(0.0, 1.0) < 0.5;
  m.crank.speed_noise = between(0.05, 0.3);
  m.crank.drop_outs.clear();
  m.drive.inertia *= between(0.7, 1.4);
  m.drive.flow *= between(0.8, 1.15);
  m.drive.relief_pressure *= between(0.9, 1.15);
  m.drive.start_time = 0.5;
  m.drive.start_ramp = between(0.2, 1.0);
  m.drive.stop_time = duration;
  m.blow.restitution_drawn = true;
  m.blow.restitution_low = between(0.05, 0.15);
  m.blow.restitution_high = m.blow.restitution_low + between(0.0, 0.1);
  if (drawn.elastic) m.rod = {between(6e8, 2e9), between(0.2, 2.0), 0.0};
  return drawn;
}

/// Instants at which the rocker of an elastic machine touches the tool [s], to 0.2 ms.
inline std::vector<double> touchesOf(const simulation::MachineSettings& machine) {
  std::vector<double> times, touches;
  for (double time = 0.0; time < machine.duration; time += 2e-4) times.push_back(time);
  for (const simulation::CrankTruth& truth : simulation::truthAt(machine, times))
    if (truth.touches()) touches.push_back(truth.time);
  return touches;
}

struct ZeroPlayed {
  std::size_t samples{}, published{}, beyond{};
  std::size_t early{}, early_published{};  ///< of the first second of motion
  double worst{};                          ///< error over standard deviation
  double worst_at{};                       ///< [s]
  double worst_blow{};                     ///< energy's error over its standard deviation, of all blows
  double worst_of_peak{};                  ///< error of Fx over its peak, after the start
  double stated{}, deviation{};            ///< error of the zero [rad]
  bool withholds{};
  std::vector<Warning> warnings;
};

/// Error of the energy of a blow at `time` [s] over its standard deviation; 0: the energy is not stated.
inline double blowError(const TurnEnd& end, double time, const std::vector<simulation::BlowTruth>& blows) {
  if (!(end.blow.energy_std > 0.0)) return 0.0;
  const auto truth = std::min_element(blows.begin(), blows.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
  return truth == blows.end() ? 0.0 : std::abs(end.blow.energy - truth->strike.energy) / end.blow.energy_std;
}

/// from: instant of the first sample that is judged [s].
inline ZeroPlayed playZero(const Settings& settings, const simulation::Session& session,
                           const std::vector<double>& touches = {}, double from = 0.0) {
  Player player(settings, false, session);
  ZeroPlayed played;
  std::size_t i = 0;
  double peak = 0.0, worst = 0.0, moves = -1.0;
  player.playTo(1e9, [&](double time, const SampleResult& result) {
    const simulation::CrankTruth& truth = session.truth[i++];
    peak = std::max(peak, std::abs(truth.load.force_x));
    if (moves < 0.0 && std::abs(truth.speed) > 1.0) moves = time;
    const bool early = moves >= 0.0 && time < moves + 1.0, is_published = !result.refusal && !result.outputs.empty();
    if (moves >= 0.0) ++(early ? played.early : played.samples);
    for (std::size_t k = 0; k < result.turn_ends; ++k)
      played.worst_blow =
          std::max(played.worst_blow,
                   blowError(result.ends[k], time + seconds(result.ends[k].stamp - result.stamp), session.blows));
    if (!is_published) return;
    if (moves >= 0.0) ++(early ? played.early_published : played.published);
    const bool strikes = std::any_of(session.blows.begin(), session.blows.end(), [&](const simulation::BlowTruth& b) {
      return std::abs(b.time - time) < kNearTouch;
    });
    const auto touch = std::lower_bound(touches.begin(), touches.end(), time - kNearTouch);
    const bool near = touch != touches.end() && *touch < time + kNearTouch;
    if (strikes || near || truth.touches() || time < from) return;
    const WrenchOutput& output = result.outputs.front();
    const Eigen::Vector3d is(truth.load.force_x, truth.load.force_z, truth.load.torque_y + truth.drive_reaction_y);
    const Eigen::Vector3d error = (vectorOf(output.wrench) - is).cwiseAbs();
    const double ratio = error.cwiseQuotient(vectorOf(output.deviation.wrench)).maxCoeff();
    if (ratio > played.worst) played.worst = ratio, played.worst_at = time;
    played.beyond += ratio > kImpossibleError;
    if (time > 4.0) worst = std::max(worst, error[0]);
  });
  played.worst_of_peak = worst / peak;
  played.withholds = player.pipeline.zeroWatch().withholds();
  const ZeroWatch::Stated stated = player.pipeline.zeroWatch().stated(player.pipeline.crank().tracker());
  played.stated = stated.error, played.deviation = stated.deviation;
  played.warnings = warningsOf(player.pipeline);
  return played;
}

}  // namespace hammer_loads::test
