#include "hammer_loads/simulation/machine_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation {
namespace {

ParameterMap given(const std::string& yaml) {
  std::vector<std::string> problems;
  return parameterMap(YAML::Load(yaml), "test.yaml", problems).value_or(ParameterMap{});
}

bool mentions(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

TEST(MachineParameters, ShippedFileIsTheWorkingMachine) {
  const Checked<SimulatorSettings> loaded = loadSimulator(configDirectory(), given("{rod: rigid, duration_s: 4.0}"));
  ASSERT_TRUE(loaded.value) << loaded.problems.front();
  MachineSettings code = workingMo100();
  code.duration = 4.0;
  code.start_stamp = loaded.value->machine.start_stamp;
  code.drive.stop_time = loaded.value->machine.drive.stop_time;
  const Session file = recordSession(loaded.value->machine), same = recordSession(code);
  ASSERT_EQ(file.crank.size(), same.crank.size());
  for (std::size_t i = 0; i < file.crank.size(); ++i) {
    ASSERT_EQ(file.crank[i].stamp, same.crank[i].stamp);
    ASSERT_NEAR(file.truth[i].load.force_z, same.truth[i].load.force_z, 1e-6 * 8e3) << i;
  }
  ASSERT_EQ(file.joints.size(), same.joints.size());
  for (std::size_t i = 0; i < file.joints.size(); ++i) ASSERT_EQ(file.joints[i].position, same.joints[i].position);
}

TEST(MachineParameters, ZeroDurationWorksForEver) {
  const Checked<SimulatorSettings> loaded = loadSimulator(configDirectory(), given("duration_s: 0"));
  ASSERT_TRUE(loaded.value);
  EXPECT_TRUE(std::isinf(loaded.value->machine.duration));
  SessionStream stream(loaded.value->machine);
  Session session;
  stream.advanceTo(4.0, session);
  EXPECT_GT(session.blows.size(), 5U);
}

TEST(MachineParameters, EveryProblemIsReportedAtOnce) {
  const Checked<SimulatorSettings> loaded =
      loadSimulator(configDirectory(), given("{crank_rate_Hz: -5, level: rokcer, shaft_inertia_kg_m2: heavy, sed: 3,"
                                             " stop_before_end_s: 30, start_angle_rad: 7}"));
  EXPECT_FALSE(loaded.value);
  for (const char* key : {"crank_rate_Hz: -5", "level: ", "shaft_inertia_kg_m2: ", "sed: ", "stop_before_end_s: 30",
                          "start_angle_rad: 7"}) {
    EXPECT_TRUE(mentions(loaded.problems, key)) << key;
  }
  EXPECT_EQ(loaded.problems.size(), 6U);
}

struct Key {
  const char* given;
  double value;
  double (*read)(const MachineSettings&);
};

TEST(MachineParameters, EveryKeyReachesItsSetting) {
  using M = const MachineSettings&;
  const Key keys[] = {
      {"seed: 7", 7.0, [](M m) { return static_cast<double>(m.seed); }},
      {"crank_rate_Hz: 100", 100.0, [](M m) { return m.crank.rate; }},
      {"measure_speed: false", 0.0, [](M m) { return m.crank.speed ? 1.0 : 0.0; }},
      {"drop_out_start_s: 3, drop_out_length_s: 0.1", 3.1, [](M m) { return m.crank.drop_outs.at(0).to; }},
      {"restitution_drawn: true, restitution_high: 0.25", 0.25, [](M m) { return m.blow.restitution_high; }},
      {"blank_share: 0.1", 0.1, [](M m) { return m.blow.blank_share; }},
      {"stamp_burst: 4", 4.0, [](M m) { return static_cast<double>(m.crank.burst); }},
      {"encoder_direction: -1", -1.0, [](M m) { return static_cast<double>(m.crank.direction); }},
      {"encoder_eccentricity_2_rad: 0.01", 0.01, [](M m) { return m.crank.eccentricity[1].amount; }},
      {"stamp_step_s: 0.001", 1e-3, [](M m) { return m.crank.stamp_step; }},
      {"stamps_only_late: true", 1.0, [](M m) { return m.crank.stamps_late ? 1.0 : 0.0; }},
      {"coupling_frequency_Hz: 50", 50.0, [](M m) { return m.drive.coupling_frequency; }},
      {"stamp_tick_s: 0.0001", 1e-4, [](M m) { return m.crank.driver.tick; }},
      {"boom_stamp_late_share: 0.2", 0.2, [](M m) { return m.boom_stamps.late_share; }},
      {"encoder_task_mean: 2", 2.0, [](M m) { return static_cast<double>(m.crank.task_mean); }},
      {"encoder_hysteresis_rad: 0.002", 2e-3, [](M m) { return m.crank.hysteresis; }},
      {"joint_count_rad: 0.002", 2e-3, [](M m) { return m.joint_count; }},
      {"joint_noise_rad: 0.0001", 1e-4, [](M m) { return m.joint_noise; }},
      {"hull_on_boom: true", 1.0, [](M m) { return m.on_boom.on ? 1.0 : 0.0; }},
      {"hull_on_boom: true", 1.0, [](M m) { return m.hammer.drive_reaction_ratio; }},
      {"oil_stiffness_factor: 0.7", 0.7, [](M m) { return m.on_boom.oil_stiffness; }},
      {"arm_cylinder_oil_factor: 0.4", 0.4, [](M m) { return m.on_boom.cylinder_oil[1]; }},
      {"boom_damping_ratio: 0.03", 0.03, [](M m) { return m.on_boom.damping; }},
      {"oil_air_share: 0.01", 0.01, [](M m) { return m.on_boom.air; }},
      {"piston_leak_m3_Pa_s: 2.0e-11", 2e-11, [](M m) { return m.on_boom.leak; }},
      {"cylinder_pin_play_m: 0.0002", 2e-4, [](M m) { return m.on_boom.pin_play; }},
      {"pressure_hose_lag_s: 0.004", 4e-3, [](M m) { return m.on_boom.pressures.hose_lag; }},
      {"pressure_count_Pa: 39000", 39e3, [](M m) { return m.on_boom.pressures.count; }},
      {"pressure_rate_Hz: 0", 0.0, [](M m) { return m.on_boom.pressures.rate; }},
      {"bus_delay_s: 0.002", 2e-3, [](M m) { return m.on_boom.bus_delay; }},
      {"link_bending_frequency_Hz: 16", 16.0, [](M m) { return m.on_boom.bending_frequency; }},
      {"imu_rate_Hz: 500", 500.0, [](M m) { return m.on_boom.imu.rate; }},
      {"imu_x_m: 0.1", 0.1, [](M m) { return m.on_boom.imu.x; }},
      {"machine_seal_friction: 0.02", 0.02, [](M m) { return m.on_boom.seals.friction; }},
      {"machine_seal_constant: 0.013", 0.013, [](M m) { return m.on_boom.seals.constant; }},
      {"machine_seal_presliding_m: 5e-5", 5e-5, [](M m) { return m.on_boom.seals.presliding; }},
      {"rock_stiffness_N_m: 2.0e7", 2e7, [](M m) { return m.on_boom.rock.stiffness; }},
      {"rock_damping_s_m: 1.5", 1.5, [](M m) { return m.on_boom.rock.damping; }},
      {"hold_down_force_N: 700", 700.0, [](M m) { return m.on_boom.rock.hold_down_force; }}};
  for (const Key& key : keys) {
    const std::string text = std::string("{rod: rigid, ") + key.given + "}";
    const Checked<SimulatorSettings> loaded = loadSimulator(configDirectory(), given(text));
    ASSERT_TRUE(loaded.value) << key.given << ": " << loaded.problems.front();
    EXPECT_EQ(key.read(loaded.value->machine), key.value) << key.given;
  }
  const PlaySettings play =
      loadSimulator(configDirectory(), given("{publish_clock: true, clock_factor: 4}")).value.value().play;
  EXPECT_TRUE(play.publish_clock);
  EXPECT_EQ(play.clock_factor, 4.0);
}

/// Settings of a rigid blow are compatible with neither an elastic rod nor a hull on its boom.
TEST(MachineParameters, RefusesWhatDoesNotGoTogether) {
  const auto expectRefused = [](const std::string& yaml, const std::vector<std::string>& beginnings) {
    const Checked<SimulatorSettings> wrong = loadSimulator(configDirectory(), given(yaml));
    EXPECT_FALSE(wrong.value);
    for (const std::string& begin : beginnings) EXPECT_TRUE(mentions(wrong.problems, begin)) << begin;
    EXPECT_EQ(wrong.problems.size(), beginnings.size()) << yaml;
  };
  expectRefused("{restitution_low: 0.4, encoder_direction: 0, rod: rigid}",
                {"restitution_high: 0.3, must be >= restitution_low = 0.4", "encoder_direction: 0"});
  const std::string rigid_blow = " tool_early_rad: 0.1, blow_crank_loss: 0.1, coupling_frequency_Hz: 50}";
  const std::vector<std::string> keys{"tool_early_rad", "blow_crank_loss", "coupling_frequency_Hz"};
  std::vector<std::string> of_rod = keys, of_boom = keys;
  of_rod.emplace_back("restitution_drawn");
  of_boom.insert(of_boom.end(), {"level", "blank_share", "oil_stiffness_factor"});
  expectRefused("{restitution_drawn: true," + rigid_blow, of_rod);
  expectRefused(
      "{rod: rigid, hull_on_boom: true, level: linkage, blank_share: 0.1, oil_stiffness_factor: 0," + rigid_blow,
      of_boom);
}

}  // namespace
}  // namespace hammer_loads::simulation
