/// Section loads on a machine that stands on the oil of its boom, judged by its truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// The torques are those of hammer, motion, vibration and rock, without weight; the sections those of the shipped file.
struct BoomErrors {
  SignalError force_x, force_z, moment, torque[3], section[3], contact;
  LifeError life_force_z, life_torque[3], life_section[3];  ///< errors of loads with weight, as they are counted
  std::size_t samples{}, refused{}, blows{};
  std::size_t withheld{};                 ///< samples without the boom's loads
  FigureErrors wrench[3];                 ///< force x, force z, moment with their deviations
  FigureErrors torques, bendings;         ///< torques of all joints with weight, bending moments of all sections
  double torque_stated[3]{};              ///< squares of the torques' deviations [N2 m2]
  double worst_force{}, largest_force{};  ///< magnitudes of the force vector [N]
  std::size_t lost_as_shown{};            ///< samples with a correct flag of a lost hold-down force
  std::set<std::string> warnings;         ///< keys of the pipeline's warnings at the end
  std::size_t unknown{};                  ///< samples at which the rock's force is reported as unknown
  double energy_sum{};                    ///< sum of the blows' relative errors
  double frequency{};                     ///< frequency of the lowest mode at the end [Hz]

  bool warnedOf(const char* key) const { return warnings.count(key) > 0; }
  bool warnedOfPressures() const { return warnedOf("pressure stamps") || warnedOf("pressure fit"); }
  double worstTorque() const { return std::max({torque[0].rms(), torque[1].rms(), torque[2].rms()}); }
  double worstSection() const {
    return std::max({section[0].rmsOfRange(), section[1].rmsOfRange(), section[2].rmsOfRange()});
  }
  double leastCorrelation() const {
    return std::min({section[0].correlation(), section[1].correlation(), section[2].correlation()});
  }
  double rmsForce() const {  ///< magnitude of the error vector, over the largest force
    return std::sqrt((force_x.square + force_z.square) / static_cast<double>(samples)) / largest_force;
  }
  double worstForce() const { return worst_force / largest_force; }
  double leastWrenchCovered() const {
    return std::min({wrench[0].result().covered, wrench[1].result().covered, wrench[2].result().covered});
  }
  double part(std::size_t count) const { return static_cast<double>(count) / static_cast<double>(samples); }
  /// Parts within two deviations, of the samples with loads of the boom; NaN without such samples.
  double covered() const { return torques.result().covered; }
  double sectionsCovered() const { return bendings.result().covered; }
  double energy() const { return energy_sum / static_cast<double>(std::max<std::size_t>(1, blows)); }  ///< mean
  /// Largest ratio of the torques' deviations to their errors, as root mean squares.
  double widest() const {
    double widest = 0.0;
    for (int j = 0; j < 3; ++j) widest = std::max(widest, std::sqrt(torque_stated[j] / torque[j].square));
    return widest;
  }

  void addBlows(const simulation::Session& session, const SampleResult& result);
  void addWrench(const simulation::OnBoomTruth& truth, const SampleResult& result);
  void addSample(const simulation::OnBoomTruth& truth, const SampleResult& result);
};

/// The shipped settings with the shipped boom and description and with `keys` (a map of YAML) over them. Throws
/// std::runtime_error when one of these files cannot be read.
Settings shippedBoom(const std::string& keys);
/// The simulated EO-2621 on its oil at work to the end [s]: joint sensors of 50 Hz that see the vibration, IMU of 1
/// kHz, pressures of 500 Hz, each with noise.
simulation::MachineSettings machineOnBoom(double duration);

struct SensorsOnBoom {
  bool imu{}, pressures{};
};

/// Over the samples from a time to another [s]; nothing of the session is left out before. settings: with a boom.
BoomErrors boomErrors(const simulation::Session& session, const Settings& settings, const SensorsOnBoom& sensors,
                      double from, double to);

}  // namespace hammer_loads::accuracy
