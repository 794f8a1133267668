/// Section loads on a machine that stands on the oil of its boom, judged by its truth.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// The torques are those of hammer, motion, vibration and rock, without weight; the sections those of the shipped file.
struct BoomErrors {
  SignalError force_x, force_z, moment, torque[3], section[3], contact;
  LifeError life_force_z, life_torque[3], life_section[3];  ///< errors of loads with weight, as they are counted
  std::size_t samples{}, refused{}, within{}, blows{};
  std::size_t withheld{};                 ///< samples without the boom's loads
  std::size_t wrench_within[3]{};         ///< number of force x, force z, moment within two standard deviations
  double worst_force{}, largest_force{};  ///< magnitudes of the force vector [N]
  double torque_said[3]{};                ///< squares of the torques' deviations [N2 m2]
  std::size_t sections_within{};          ///< bending moments within two deviations
  std::size_t lost_as_shown{};            ///< samples with a correct flag of a lost hold-down force
  bool warned_of_rock{}, warned_of_pressure_stamps{}, warned_of_pressure_fit{}, warned_of_imu_stamps{},
      warned_of_damping{}, warned_of_loads{};
  std::size_t unknown{};  ///< samples at which the rock's force is reported as unknown
  double energy_sum{};    ///< sum of the blows' relative errors
  double frequency{};     ///< frequency of the lowest mode at the end [Hz]

  bool warnedOfPressures() const { return warned_of_pressure_stamps || warned_of_pressure_fit; }
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
    return part(*std::min_element(std::begin(wrench_within), std::end(wrench_within)));
  }
  double part(std::size_t count) const { return static_cast<double>(count) / static_cast<double>(samples); }
  /// Returns the part of three torques in each sample that has them; NaN where none has.
  double partOfTorques(std::size_t count) const {
    return static_cast<double>(count) / (3.0 * static_cast<double>(samples - withheld));
  }
  double sectionsCovered() const { return partOfTorques(sections_within); }
  double covered() const { return partOfTorques(within); }
  double energy() const { return energy_sum / static_cast<double>(std::max<std::size_t>(1, blows)); }  ///< mean
  /// Largest ratio of the torques' deviations to their errors, as root mean squares.
  double widest() const {
    double widest = 0.0;
    for (int j = 0; j < 3; ++j) widest = std::max(widest, std::sqrt(torque_said[j] / torque[j].square));
    return widest;
  }
  std::string text() const;  ///< one line

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

/// Over the samples from a time to another [s]; nothing of the session is left out before. boom: the shipped one.
BoomErrors boomErrors(const simulation::Session& session, const Mechanism& mechanism, const PipelineSettings& settings,
                      const Boom& boom, const SensorsOnBoom& sensors, double from, double to);

}  // namespace hammer_loads::accuracy
