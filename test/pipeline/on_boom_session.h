/// Sessions of a machine whose hull hangs on its boom, played into a pipeline and judged by their truth: an unseen
/// pose, a boom that moves, sensors with rates of their own. Joint sensors see the vibration.
#pragma once

#include <gtest/gtest.h>

#include "hammer_loads/pipeline/warnings.h"
#include "support/error_of_signal.h"
#include "support/session_player.h"

namespace hammer_loads::test {

constexpr double kJudgedFrom = 6.0, kJudgedTo = 10.0;  ///< [s]: the machine works from 2 s on

inline simulation::MachineSettings machineOnBoom(double oil, double joint_rate) {
  simulation::MachineSettings m = simulation::workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.duration = kJudgedTo;
  m.drive.stop_time = 1e9;
  m.seed = 41;
  m.boom[1].mean = -0.45, m.boom[2].mean = 1.00, m.boom[3].mean = -0.50;
  m.joint_rate = joint_rate;
  m.joint_noise = 1e-4;
  m.on_boom.on = true;
  m.on_boom.oil_stiffness = oil;
  m.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
  m.on_boom.pressures = {500.0, 2e4, 6e6};
  return m;
}

struct SessionMisses {
  Error force_z, moment, torque[3], section[3], contact;
  std::size_t samples{}, refused{}, within{}, blows{};
  std::size_t sections_within{};  ///< bending moments within two deviations
  std::size_t lost_as_shown{};    ///< the flag of a press force that is lost is right
  bool warned_of_rock{};
  std::size_t unknown{};  ///< the rock's force is said not to be known
  double energy{};        ///< mean, relative
  double frequency{};     ///< of the lowest mode at the end [Hz]

  double worstTorque() const { return std::max({torque[0].rms(), torque[1].rms(), torque[2].rms()}); }
  double worstSection() const {
    return std::max({section[0].rmsOfRange(), section[1].rmsOfRange(), section[2].rmsOfRange()});
  }
  double leastCorrelation() const {
    return std::min({section[0].correlation(), section[1].correlation(), section[2].correlation()});
  }
  double part(std::size_t count) const { return static_cast<double>(count) / static_cast<double>(samples); }
  double sectionsCovered() const { return part(sections_within) / 3.0; }
  double covered() const { return static_cast<double>(within) / static_cast<double>(3 * samples); }
  void print(const std::string& name) const {
    std::printf(
        "%s: Fz %.2f|%.2f  My %.2f  torques %.2f %.2f %.2f  sections %.2f %.2f %.2f (correlation %.4f)  "
        "energy %.2f  covered %.0f %% %.0f %%  %.2f Hz  contact %.2f  flag %.0f %%\n",
        name.c_str(), 100 * force_z.rmsOfLargest(), 100 * force_z.worstOfLargest(), 100 * moment.rms(),
        100 * torque[0].rms(), 100 * torque[1].rms(), 100 * torque[2].rms(), 100 * section[0].rmsOfRange(),
        100 * section[1].rmsOfRange(), 100 * section[2].rmsOfRange(), leastCorrelation(), 100 * energy, 100 * covered(),
        100 * sectionsCovered(), frequency, 100 * contact.rmsOfRange(), 100 * part(lost_as_shown));
  }
};

struct SensorsOnBoom {
  bool imu{}, pressures{};
};

inline void addBlows(const simulation::Session& session, const SampleResult& result, SessionMisses& e) {
  for (std::size_t k = 0; k < result.turn_ends; ++k) {
    const double time = seconds(result.ends[k].stamp - simulation::workingMo100().start_stamp);
    for (const simulation::BlowTruth& blow : session.blows) {
      if (std::abs(blow.time - time) > 0.005) continue;
      e.energy += result.ends[k].blow.energy / blow.strike.energy - 1.0;
      ++e.blows;
    }
  }
}

inline void addSample(const simulation::OnBoomTruth& t, const SampleResult& result, SessionMisses& e) {
  ++e.samples;
  e.force_z.add(result.wrench.force_z, t.load.force_z);
  e.moment.add(result.wrench.torque_y, t.load.torque_y + t.drive_reaction_y);
  const BoomState& boom = *result.boom;
  for (int j = 0; j < 3; ++j) {
    const double weight = boom.loads.weight[j + 1], total = boom.loads.total[j + 1];
    e.torque[j].add(total - weight, -t.hold[j] - weight);
    e.within += std::abs(total + t.hold[j]) <= 2.0 * boom.deviations.torque[j + 1];
  }
  for (std::size_t s = 0; s < 3; ++s) {
    const double bending = boom.steel.section[s].torque.y(), truth = t.cut[s].torque_y;
    e.section[s].add(bending, truth);
    e.sections_within += std::abs(bending - truth) <= 2.0 * boom.deviations.section[s].torque.y();
  }
  e.contact.add(boom.contact.force.z(), t.rock.force_z);
  e.lost_as_shown += boom.press_force_lost == (t.rock.force_z < 1.0);
  e.unknown += boom.contact_unknown;
}

inline SessionMisses errorsOf(const std::string& name, const simulation::Session& session,
                              const std::string& parameters, const SensorsOnBoom& sensors) {
  Player player(settingsWith("boom: compliant\n" + parameters), true, session);
  player.imu_speaks = sensors.imu, player.pressures_speak = sensors.pressures;
  SessionMisses e;
  std::size_t i = 0;
  player.playTo(kJudgedTo, [&](double time, const SampleResult& result) {
    const simulation::OnBoomTruth& truth = session.on_boom[i++];
    if (time < kJudgedFrom) return;
    addBlows(session, result, e);
    const bool known = !result.refusal && result.boom != nullptr && !result.boom->fault;
    if (known) {
      addSample(truth, result, e);
      e.frequency = result.boom->frequency[0];
    }
    e.refused += !known;
  });
  for (const Warning& warning : warningsOf(player.pipeline)) e.warned_of_rock |= std::string(warning.key) == "rock";
  e.energy /= static_cast<double>(std::max<std::size_t>(1, e.blows));
  e.print(name);
  EXPECT_EQ(e.refused, 0U) << name;
  EXPECT_GT(e.blows, 15U) << name;
  return e;
}

}  // namespace hammer_loads::test
