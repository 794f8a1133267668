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

TEST(MachineParameters, GivenKeysReplaceShippedOnes) {
  const Checked<SimulatorSettings> loaded = loadSimulator(
      configDirectory(), given("{seed: 7, crank_rate_Hz: 100, drop_out_start_s: 3, drop_out_length_s: 0.1,"
                               " measure_speed: false, publish_clock: true, clock_factor: 4}"));
  ASSERT_TRUE(loaded.value) << loaded.problems.front();
  EXPECT_EQ(loaded.value->machine.seed, 7U);
  EXPECT_EQ(loaded.value->machine.crank.rate, 100.0);
  EXPECT_FALSE(loaded.value->machine.crank.speed);
  ASSERT_EQ(loaded.value->machine.crank.drop_outs.size(), 1U);
  EXPECT_EQ(loaded.value->machine.crank.drop_outs[0].to, 3.1);
  EXPECT_TRUE(loaded.value->play.publish_clock);
  EXPECT_EQ(loaded.value->play.clock_factor, 4.0);
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

TEST(MachineParameters, FlawsAreRead) {
  const Checked<SimulatorSettings> loaded = loadSimulator(
      configDirectory(),
      given("{rod: rigid, restitution_drawn: true, restitution_low: 0.1, restitution_high: 0.25, stamp_burst: 4,"
            " encoder_direction: -1, encoder_eccentricity_2_rad: 0.01, coupling_frequency_Hz: 50,"
            " stamp_step_s: 0.001, stamps_only_late: true, blank_share: 0.1, stamp_tick_s: 0.0001,"
            " boom_stamp_late_share: 0.2, encoder_task_mean: 2, encoder_hysteresis_rad: 0.002}"));
  ASSERT_TRUE(loaded.value) << loaded.problems.front();
  const MachineSettings& machine = loaded.value->machine;
  EXPECT_TRUE(machine.blow.restitution_drawn);
  EXPECT_EQ(machine.blow.restitution_high, 0.25);
  EXPECT_EQ(machine.blow.blank_share, 0.1);
  EXPECT_EQ(machine.crank.burst, 4);
  EXPECT_EQ(machine.crank.direction, -1);
  EXPECT_EQ(machine.crank.eccentricity[1].amount, 0.01);
  EXPECT_EQ(machine.crank.stamp_step, 0.001);
  EXPECT_TRUE(machine.crank.stamps_late);
  EXPECT_EQ(machine.drive.coupling_frequency, 50.0);
  EXPECT_EQ(machine.crank.driver.tick, 1e-4);
  EXPECT_EQ(machine.boom_stamps.late_share, 0.2);
  EXPECT_EQ(machine.crank.task_mean, 2);
  EXPECT_EQ(machine.crank.hysteresis, 2e-3);
  const Checked<SimulatorSettings> wrong =
      loadSimulator(configDirectory(), given("{restitution_low: 0.4, encoder_direction: 0}"));
  EXPECT_TRUE(mentions(wrong.problems, "restitution_high: 0.3, must be >= restitution_low = 0.4"));
  EXPECT_TRUE(mentions(wrong.problems, "encoder_direction: 0"));
}

TEST(MachineParameters, AHullOnItsBoomIsSwitchedOnAndRefusesWhatItDoesNotGoWith) {
  const OnBoomSettings shipped = loadSimulator(configDirectory(), {}).value->machine.on_boom;
  EXPECT_FALSE(shipped.on);
  EXPECT_TRUE(shipped.isPlain());
  EXPECT_EQ(shipped.bending_frequency, 0.0);
  EXPECT_EQ(shipped.seals.friction, 0.02) << "of all its flaws the one that every machine has";
  EXPECT_EQ(loadSimulator(configDirectory(), {}).value->machine.on_boom.rock.stiffness, 0.0) << "it hangs free";
  const Checked<SimulatorSettings> loaded = loadSimulator(
      configDirectory(),
      given("{rod: rigid, hull_on_boom: true, oil_stiffness_factor: 0.7, boom_damping_ratio: 0.03, imu_rate_Hz: 500,"
            " arm_cylinder_oil_factor: 0.4, oil_air_share: 0.01, piston_leak_m3_Pa_s: 2.0e-11, cylinder_pin_play_m: "
            "0.0002,"
            " pressure_hose_lag_s: 0.004, pressure_count_Pa: 39000, bus_delay_s: 0.002, joint_count_rad: 0.002, "
            "link_bending_frequency_Hz: 16,"
            " imu_x_m: 0.1, pressure_rate_Hz: 0, machine_seal_friction: 0.02, machine_seal_constant: 0.013, "
            "machine_seal_presliding_m: 5e-5, "
            "joint_noise_rad: 0.0001, "
            "restitution_drawn: true,"
            " rock_stiffness_N_m: 2.0e7, rock_damping_s_m: 1.5, hold_down_force_N: 700}"));
  ASSERT_TRUE(loaded.value) << loaded.problems.front();
  const MachineSettings& machine = loaded.value->machine;
  EXPECT_TRUE(machine.on_boom.on);
  EXPECT_EQ(machine.on_boom.oil_stiffness, 0.7);
  EXPECT_EQ(machine.on_boom.cylinder_oil, (std::array<double, 3>{1.0, 0.4, 1.0}));
  EXPECT_EQ(machine.on_boom.damping, 0.03);
  EXPECT_EQ(machine.on_boom.air, 0.01);
  EXPECT_EQ(machine.on_boom.leak, 2e-11);
  EXPECT_EQ(machine.on_boom.pin_play, 2e-4);
  EXPECT_EQ(machine.on_boom.pressures.hose_lag, 4e-3);
  EXPECT_EQ(machine.on_boom.pressures.count, 39e3);
  EXPECT_EQ(machine.on_boom.bus_delay, 2e-3);
  EXPECT_EQ(machine.joint_count, 2e-3);
  EXPECT_EQ(machine.on_boom.bending_frequency, 16.0);
  EXPECT_EQ(machine.on_boom.imu.rate, 500.0);
  EXPECT_EQ(machine.on_boom.imu.x, 0.1);
  EXPECT_EQ(machine.on_boom.pressures.rate, 0.0);
  EXPECT_EQ(machine.on_boom.seals.friction, 0.02);
  EXPECT_EQ(machine.on_boom.seals.constant, 0.013);
  EXPECT_EQ(machine.on_boom.seals.presliding, 5e-5);
  EXPECT_EQ(machine.on_boom.rock.stiffness, 2e7);
  EXPECT_EQ(machine.on_boom.rock.damping, 1.5);
  EXPECT_EQ(machine.on_boom.rock.hold_down_force, 700.0);
  EXPECT_EQ(machine.joint_noise, 1e-4);
  EXPECT_EQ(machine.hammer.drive_reaction_ratio, 1.0);
  const Checked<SimulatorSettings> wrong = loadSimulator(
      configDirectory(), given("{rod: rigid, hull_on_boom: true, level: linkage, blank_share: 0.1, tool_early_rad: 0.1,"
                               " blow_crank_loss: 0.1, coupling_frequency_Hz: 50, oil_stiffness_factor: 0}"));
  EXPECT_FALSE(wrong.value);
  for (const char* key : {"level", "blank_share", "tool_early_rad", "blow_crank_loss", "coupling_frequency_Hz"})
    EXPECT_TRUE(mentions(wrong.problems, std::string(key))) << key;
  EXPECT_EQ(wrong.problems.size(), 6U);
}

TEST(MachineParameters, ShippedRodGivesAndRefusesTheRulesOfARigidBlow) {
  const MachineSettings shipped = loadSimulator(configDirectory(), {}).value->machine;
  EXPECT_EQ(shipped.rod.stiffness, 7e8);
  EXPECT_EQ(shipped.rod.damping_ratio, 0.4);
  EXPECT_EQ(shipped.rod.play, 1e-4);
  const StrikeSettings code;
  EXPECT_EQ(shipped.strike.tool_mass, code.tool_mass);
  EXPECT_EQ(shipped.strike.contact_stiffness, code.contact_stiffness);
  EXPECT_EQ(shipped.strike.contact_damping, code.contact_damping);
  EXPECT_EQ(shipped.strike.rock_stiffness, code.rock_stiffness);
  EXPECT_EQ(shipped.strike.rock_strength, code.rock_strength);
  EXPECT_EQ(loadSimulator(configDirectory(), given("rod: rigid")).value->machine.rod.stiffness, 0.0);
  const Checked<SimulatorSettings> wrong =
      loadSimulator(configDirectory(), given("{restitution_drawn: true, tool_early_rad: 0.1, blow_crank_loss: 0.1,"
                                             " coupling_frequency_Hz: 50}"));
  EXPECT_FALSE(wrong.value);
  for (const char* key : {"restitution_drawn", "tool_early_rad", "blow_crank_loss", "coupling_frequency_Hz"})
    EXPECT_TRUE(mentions(wrong.problems, std::string(key))) << key;
  EXPECT_EQ(wrong.problems.size(), 4U);
}

}  // namespace
}  // namespace hammer_loads::simulation
