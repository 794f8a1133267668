#include "hammer_loads/simulation/machine_parameters.h"

#include <array>
#include <limits>
#include <utility>

#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/simulation/oil_boom.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::simulation {
namespace {

constexpr NumberRule kAny = NumberRule::any();
constexpr NumberRule kPositive = NumberRule::positive();
constexpr NumberRule kNotNegative = NumberRule::notNegative();
constexpr std::int64_t kLargestSeed = std::int64_t{1} << 53;  // exact in every reader of YAML
constexpr std::int64_t kMostCounts = 1 << 24;
constexpr std::int64_t kMostBurst = 10000;
constexpr std::array<std::pair<const char*, bool>, 2> kRodNames{{{"rigid", false}, {"elastic", true}}};

DriveSettings readDrive(ParameterReader& reader) {
  DriveSettings d;
  d.motor_displacement = reader.number("motor_displacement_m3_rad", "m3/rad", kPositive);
  d.compliance = reader.number("line_compliance_m3_Pa", "m3/Pa", kPositive);
  d.leakage = reader.number("leakage_m3_s_Pa", "m3/(s Pa)", kNotNegative);
  d.relief_pressure = reader.number("relief_pressure_Pa", "Pa", kPositive);
  d.relief_slope = reader.number("relief_slope_m3_s_Pa", "m3/(s Pa)", kNotNegative);
  d.coulomb_friction = reader.number("coulomb_friction_Nm", "N m", kNotNegative);
  d.viscous_friction = reader.number("viscous_friction_Nm_s", "N m s/rad", kNotNegative);
  d.friction_speed = reader.number("friction_speed_rad_s", "rad/s", kPositive);
  d.inertia = reader.number("shaft_inertia_kg_m2", "kg m2", kPositive);
  d.flow = reader.number("flow_m3_s", "m3/s", kPositive);
  d.flow_variation = reader.number("flow_variation", "", kNotNegative);
  d.flow_variation_period = reader.number("flow_variation_period_s", "s", kPositive);
  d.ripple = reader.number("ripple", "", kNotNegative);
  d.ripple_frequency = reader.number("ripple_frequency_Hz", "Hz", kNotNegative);
  d.start_time = reader.number("start_time_s", "s", kNotNegative);
  d.start_ramp = reader.number("start_ramp_s", "s", kPositive);
  d.stop_ramp = reader.number("stop_ramp_s", "s", kPositive);
  d.bypass = reader.number("bypass_m3_s_Pa", "m3/(s Pa)", kNotNegative);
  d.coupling_frequency = reader.number("coupling_frequency_Hz", "Hz", kNotNegative);
  d.motor_share = reader.number("coupling_motor_share", "", NumberRule::within(1e-3, 1.0 - 1e-3));
  d.coupling_damping = reader.number("coupling_damping", "", kNotNegative);
  return d;
}

BlowSettings readBlow(ParameterReader& reader) {
  BlowSettings b;
  b.restitution_drawn = reader.boolean("restitution_drawn");
  b.restitution_low = reader.number("restitution_low", "", NumberRule::within(-1.0, 1.0));
  b.restitution_high = reader.number("restitution_high", "", NumberRule::within(-1.0, 1.0));
  if (b.restitution_high < b.restitution_low) {
    reader.addProblem(
        format("restitution_high: %.9g, must be >= restitution_low = %.9g", b.restitution_high, b.restitution_low));
  }
  b.crank_loss = reader.number("blow_crank_loss", "", NumberRule::within(0.0, 0.99));
  b.tool_early = reader.number("tool_early_rad", "rad", NumberRule::within(0.0, 1.0));
  b.early_tool_mass = reader.number("early_tool_mass_kg", "kg", kPositive);
  b.blank_share = reader.number("blank_share", "", NumberRule::within(0.0, 1.0));
  return b;
}

/// Returns stiffness 0 for `rod: rigid`.
RodSettings readRod(ParameterReader& reader) {
  RodSettings r;
  const bool elastic = reader.choice("rod", kRodNames);
  r.stiffness = reader.number("machine_rod_stiffness_N_m", "N/m", kPositive);
  r.damping_ratio = reader.number("machine_rod_damping_ratio", "", kNotNegative);
  r.play = reader.number("machine_pin_play_m", "m", NumberRule::within(0.0, 0.005));
  if (!elastic) r = {};
  return r;
}

StrikeSettings readStrike(ParameterReader& reader) {
  StrikeSettings s;
  s.tool_mass = reader.number("tool_mass_kg", "kg", kPositive);
  s.contact_stiffness = reader.number("contact_stiffness_N_m", "N/m", kPositive);
  s.contact_damping = reader.number("contact_damping_s_m", "s/m", kNotNegative);
  s.rock_stiffness = reader.number("tool_rock_stiffness_N_m", "N/m", kPositive);
  s.rock_damping = reader.number("tool_rock_damping_s_m", "s/m", kNotNegative);
  s.rock_strength = reader.number("tool_rock_strength_N", "N", kPositive);
  s.tool_late = reader.number("tool_late_m", "m", NumberRule::within(-0.05, 0.05));
  s.tool_spread = reader.number("tool_spread_m", "m", NumberRule::within(0.0, 0.05));
  s.retainer_stiffness = reader.number("retainer_stiffness_N_m", "N/m", kNotNegative);
  s.retainer_damping = reader.number("retainer_damping_s_m", "s/m", kNotNegative);
  s.retainer_gap = reader.number("retainer_gap_m", "m", NumberRule::within(0.0, 0.05));
  s.no_tool_from = reader.number("no_tool_start_s", "s", kNotNegative);
  s.no_tool_to = s.no_tool_from + reader.number("no_tool_length_s", "s", kNotNegative);
  return s;
}

/// Reads the stamps of a driver; `prefix` is that of the keys.
DriverStamps readDriverStamps(ParameterReader& reader, const std::string& prefix) {
  DriverStamps s;
  s.tick = reader.number(prefix + "stamp_tick_s", "s", NumberRule::within(0.0, 1.0));
  s.late_share = reader.number(prefix + "stamp_late_share", "", NumberRule::within(0.0, 1.0));
  s.late_mean = reader.number(prefix + "stamp_late_mean_s", "s", NumberRule::within(0.0, 1.0));
  return s;
}

/// Reads the mounting of the encoder on the crank.
void readEncoder(ParameterReader& reader, CrankSensorSettings& s) {
  s.zero = reader.number("encoder_zero_rad", "rad", kAny);
  s.direction = static_cast<int>(reader.integer("encoder_direction", "", -1, 1));
  if (s.direction == 0) reader.addProblem("encoder_direction: 0, must be 1 or -1");
  s.ratio = reader.number("encoder_ratio", "", kPositive);
  s.angle_lag = reader.number("encoder_lag_s", "s", NumberRule::within(0.0, 1.0));
  s.slip.amount = reader.number("encoder_slip_rad", "rad", kAny);
  s.slip.during.from = reader.number("encoder_slip_start_s", "s", kNotNegative);
  const double slips_for = reader.number("encoder_slip_length_s", "s", kNotNegative);
  s.slip.during.to = slips_for > 0.0 ? s.slip.during.from + slips_for : kNever;
  s.eccentricity[0].amount = reader.number("encoder_eccentricity_1_rad", "rad", NumberRule::within(0.0, 0.4));
  s.eccentricity[0].phase = reader.number("encoder_eccentricity_1_phase_rad", "rad", kAny);
  s.eccentricity[1].amount = reader.number("encoder_eccentricity_2_rad", "rad", NumberRule::within(0.0, 0.2));
  s.eccentricity[1].phase = reader.number("encoder_eccentricity_2_phase_rad", "rad", kAny);
  s.hysteresis = reader.number("encoder_hysteresis_rad", "rad", NumberRule::within(0.0, 0.1));
  s.task_period = reader.number("encoder_task_period_s", "s", NumberRule::within(0.0, 1.0));
  s.task_mean = static_cast<int>(reader.integer("encoder_task_mean", "", 1, kMostBurst));
}

CrankSensorSettings readCrankSensor(ParameterReader& reader) {
  CrankSensorSettings s;
  s.rate = reader.number("crank_rate_Hz", "Hz", kPositive);
  s.jitter = reader.number("crank_jitter_s", "s", kNotNegative);
  s.stamp_noise = reader.number("stamp_noise_s", "s", kNotNegative);
  s.driver = readDriverStamps(reader, "");
  s.stamps_late = reader.boolean("stamps_only_late");
  s.stamp_step = reader.number("stamp_step_s", "s", NumberRule::within(0.0, 1.0));
  s.latency = reader.number("stamp_latency_s", "s", NumberRule::within(0.0, 1.0));
  s.burst = static_cast<int>(reader.integer("stamp_burst", "", 1, kMostBurst));
  s.stamps_ordered = reader.boolean("stamps_ordered");
  s.duplicate_share = reader.number("duplicate_share", "", NumberRule::within(0.0, 1.0));
  s.loss_share = reader.number("loss_share", "", NumberRule::within(0.0, 0.99));
  readEncoder(reader, s);
  s.counts = static_cast<int>(reader.integer("encoder_counts", "", 0, kMostCounts));
  s.unwound = reader.boolean("unwound");
  s.speed = reader.boolean("measure_speed");
  s.speed_noise = reader.number("crank_speed_noise_rad_s", "rad/s", kNotNegative);
  s.speed_lag = reader.number("speed_lag_s", "s", NumberRule::within(0.0, 1.0));
  s.speed_scale = reader.number("speed_scale", "", kPositive);
  const double from = reader.number("drop_out_start_s", "s", kNotNegative);
  const double length = reader.number("drop_out_length_s", "s", kNotNegative);
  if (length > 0.0) s.drop_outs.push_back({from, from + length});
  return s;
}

OnBoomSettings readOnBoom(ParameterReader& reader) {
  OnBoomSettings s;
  s.on = reader.boolean("hull_on_boom");
  s.oil_stiffness = reader.number("oil_stiffness_factor", "", kPositive);
  for (std::size_t k = 0; k < s.cylinder_oil.size(); ++k)
    s.cylinder_oil[k] = reader.number(std::string(kBoomCylinders[k]) + "_oil_factor", "", kPositive);
  s.air = reader.number("oil_air_share", "", NumberRule::within(0.0, 0.1));
  s.leak = reader.number("piston_leak_m3_Pa_s", "m3/(Pa s)", NumberRule::within(0.0, 1e-9));
  s.pin_play = reader.number("cylinder_pin_play_m", "m", NumberRule::within(0.0, 0.01));
  s.bending_frequency = reader.number("link_bending_frequency_Hz", "Hz", kNotNegative);
  s.damping = reader.number("boom_damping_ratio", "", NumberRule::within(0.0, 0.99));
  s.step = reader.number("boom_step_s", "s", kPositive);
  s.seals.friction = reader.number("machine_seal_friction", "", NumberRule::within(0.0, 0.2));
  s.seals.constant = reader.number("machine_seal_constant", "", NumberRule::within(0.0, 0.2));
  s.seals.presliding = reader.number("machine_seal_presliding_m", "m", NumberRule::within(0.0, 0.001));
  s.rock.stiffness = reader.number("rock_stiffness_N_m", "N/m", kNotNegative);
  s.rock.damping = reader.number("rock_damping_s_m", "s/m", kNotNegative);
  s.rock.hold_down_force = reader.number("hold_down_force_N", "N", kNotNegative);
  s.imu.rate = reader.number("imu_rate_Hz", "Hz", kNotNegative);
  s.imu.x = reader.number("imu_x_m", "m", kAny);
  s.imu.z = reader.number("imu_z_m", "m", kAny);
  s.imu.pitch = reader.number("imu_pitch_rad", "rad", kAny);
  s.imu.acceleration_noise = reader.number("imu_acceleration_noise_m_s2", "m/s2", kNotNegative);
  s.imu.rate_noise = reader.number("imu_rate_noise_rad_s", "rad/s", kNotNegative);
  s.pressures.rate = reader.number("pressure_rate_Hz", "Hz", kNotNegative);
  s.pressures.noise = reader.number("pressure_noise_Pa", "Pa", kNotNegative);
  s.pressures.preload = reader.number("cylinder_preload_Pa", "Pa", kNotNegative);
  s.pressures.hose_lag = reader.number("pressure_hose_lag_s", "s", NumberRule::within(0.0, 1.0));
  s.pressures.count = reader.number("pressure_count_Pa", "Pa", kNotNegative);
  s.bus_delay = reader.number("bus_delay_s", "s", NumberRule::within(0.0, 1.0));
  return s;
}

/// Reports settings of a rigid blow with a hull on its boom, or with an elastic rod, whose blow follows from contact.
void checkBlow(ParameterReader& reader, const MachineSettings& machine) {
  const bool on_boom = machine.on_boom.on, elastic = machine.rod.stiffness > 0.0;
  const auto mustBeZero = [&](const char* key, double value) {
    for (const auto& [is_on, name] : {std::pair{on_boom, "hull_on_boom: true"}, {elastic, "rod: elastic"}})
      if (is_on && value > 0.0) reader.addProblem(format("%s: %.9g, must be 0 with %s", key, value, name));
  };
  mustBeZero("coupling_frequency_Hz", machine.drive.coupling_frequency);
  mustBeZero("blow_crank_loss", machine.blow.crank_loss);
  mustBeZero("tool_early_rad", machine.blow.tool_early);
  if (on_boom && machine.level != Level::kRocker) reader.addProblem("level: must be rocker with hull_on_boom: true");
  if (on_boom && machine.blow.blank_share > 0.0)
    reader.addProblem(format("blank_share: %.9g, must be 0 with hull_on_boom: true", machine.blow.blank_share));
  if (elastic && machine.blow.restitution_drawn)
    reader.addProblem("restitution_drawn: true, must be false with rod: elastic");
}

JointMotion readJoint(ParameterReader& reader, const std::string& joint) {
  JointMotion motion;
  motion.mean = reader.number(joint + "_mean_rad", "rad", kAny);
  motion.amplitude = reader.number(joint + "_amplitude_rad", "rad", kAny);
  motion.period = reader.number(joint + "_period_s", "s", kPositive);
  motion.phase = reader.number(joint + "_phase_rad", "rad", kAny);
  return motion;
}

/// Reads duration and stop; both are infinite for a duration of 0.
void readTimes(ParameterReader& reader, MachineSettings& machine) {
  const double duration = reader.number("duration_s", "s", kNotNegative);
  const double before_end = reader.number("stop_before_end_s", "s", kNotNegative);
  machine.duration = duration > 0.0 ? duration : std::numeric_limits<double>::infinity();
  machine.drive.stop_time = machine.duration - before_end;
  if (machine.drive.stop_time < 0.0) {
    reader.addProblem(
        format("stop_before_end_s: %.9g s, must be <= duration_s = %.9g s, or duration_s 0", before_end, duration));
  }
}

MachineSettings readMachine(ParameterReader& reader) {
  MachineSettings machine;
  machine.level = reader.choice("level", kRigidLevelNames);
  machine.drive = readDrive(reader);
  machine.blow = readBlow(reader);
  machine.rod = readRod(reader);
  machine.strike = readStrike(reader);
  machine.crank = readCrankSensor(reader);
  machine.boom = {readJoint(reader, "swing"), readJoint(reader, "boom"), readJoint(reader, "arm"),
                  readJoint(reader, "hammer")};
  machine.boom_stamps = readDriverStamps(reader, "boom_");
  machine.joint_rate = reader.number("joint_rate_Hz", "Hz", kPositive);
  machine.joint_count = reader.number("joint_count_rad", "rad", kNotNegative);
  machine.joint_noise = reader.number("joint_noise_rad", "rad", kNotNegative);
  machine.joint_speed_noise = reader.number("joint_speed_noise_rad_s", "rad/s", kNotNegative);
  machine.on_boom = readOnBoom(reader);
  machine.gravity = reader.number("gravity_m_s2", "m/s2", kNotNegative);
  machine.start_angle = reader.number("start_angle_rad", "rad", NumberRule::within(1e-9, kTwoPi - 1e-9));
  machine.step = reader.number("integration_step_s", "s", kPositive);
  machine.seed = static_cast<std::uint64_t>(reader.integer("seed", "", 0, kLargestSeed));
  readTimes(reader, machine);
  checkBlow(reader, machine);
  return machine;
}

}  // namespace

Checked<SimulatorSettings> loadSimulator(const std::string& config_directory, const ParameterMap& given) {
  Checked<SimulatorSettings> result;
  std::vector<std::string> shipped{config_directory + "/simulated_machine.yaml"};
  if (!hasHammerKey(given)) shipped.push_back(config_directory + "/hammer_mo100.yaml");
  ParameterMap parameters;
  for (const std::string& file : shipped) {
    if (const std::optional<ParameterMap> read = readParameterFile(file, result.problems)) merge(*read, parameters);
  }
  if (!result.problems.empty()) return result;
  merge(given, parameters);

  ParameterReader reader(std::move(parameters));
  SimulatorSettings settings;
  settings.machine = readMachine(reader);
  settings.play.publish_clock = reader.boolean("publish_clock");
  settings.play.clock_factor = reader.number("clock_factor", "", kPositive);
  settings.play.wait_for_subscriber = reader.number("wait_for_subscriber_s", "s", kNotNegative);
  if (const std::string prefix = reader.text("truth_prefix"); prefix != "none") settings.play.truth_prefix = prefix;
  if (const std::optional<Mechanism> mechanism = readMechanism(reader, result.notes))
    settings.machine.hammer = mechanism->parameters();
  reader.reportUnknownKeys();
  result.problems = reader.problems();
  if (result.problems.empty()) result.value = settings;
  return result;
}

}  // namespace hammer_loads::simulation
