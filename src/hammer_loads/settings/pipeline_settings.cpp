#include "hammer_loads/settings/pipeline_settings.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

// Bounds that no machine, sensor or supply exceeds. For all values within them, the pipeline ends, allocates little and
// its arithmetic stays finite: test/fuzz/pipeline_fuzz.cpp draws every one of them.
constexpr NumberRule kTurned = NumberRule::within(-6.3, 6.3);     // [rad] a revolution either way; degrees lie beyond
constexpr NumberRule kPlace = NumberRule::within(-100.0, 100.0);  // [m] place on a machine
constexpr NumberRule kAge = NumberRule::within(1e-3, 10.0);       // [s] a sample at 1 kHz to a rest between two blows
constexpr NumberRule kPart = NumberRule::within(1e-9, 10.0);      // [-] part of a peak, as in cfg/HammerLoads.cfg
// Output rate [Hz], as in cfg/HammerLoads.cfg: one core computes and sends some 30000 wrenches a second, and a sample
// after a gap of stale_after has 1e5 outputs at most, 30 MB.
constexpr NumberRule kOutputRate = NumberRule::zeroOrWithin(1e-3, 1e4);

/// Returns true if a link's name can be a part of a topic's name.
bool namesATopic(const std::string& link) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto allowed = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '/'; };
  return letter(link.front()) && link.back() != '/' && std::all_of(link.begin(), link.end(), allowed);
}

void readBoom(ParameterReader& reader, PipelineSettings& s) {
  s.boom = reader.choice("boom", kBoomModelNames);
  s.boom_acceleration = reader.choice("boom_acceleration", kBoomAccelerationNames);
  s.boom_stiffness = reader.choice("boom_stiffness", kBoomStiffnessNames);
  s.joint_max_age = reader.number("joint_max_age_s", "s", kAge);
  s.boom_wrench_links = reader.names("boom_wrench_links");
  for (const std::string& link : s.boom_wrench_links) {
    if (namesATopic(link)) continue;
    reader.addProblem(
        format("boom_wrench_links: %s, must be names of a letter first, then letters, digits, _ and /", link.c_str()));
  }
  s.tf_max_wait = reader.number("tf_max_wait_s", "s", NumberRule::within(1e-3, 60.0));
}

void readHullMotion(ParameterReader& reader, PipelineSettings& s) {
  s.hull_motion = reader.choice("hull_motion", kHullMotionNames);
  if (s.hull_motion == HullMotionSource::kModel && (s.boom == BoomModel::kNone || s.boom == BoomModel::kRigid))
    reader.addProblem("hull_motion: model, must be unmeasured, fixed or imu with a boom that is none or rigid");
  const double x = reader.number("imu_x_m", "m", kPlace), y = reader.number("imu_y_m", "m", kPlace);
  s.imu.position = {x, y, reader.number("imu_z_m", "m", kPlace)};
  s.imu.position_std = reader.number("imu_position_std_m", "m", NumberRule::within(0.0, 10.0));
  const double roll = reader.number("imu_roll_rad", "rad", kTurned),
               pitch = reader.number("imu_pitch_rad", "rad", kTurned);
  s.imu.rotation = rotationOf(roll, pitch, reader.number("imu_yaw_rad", "rad", kTurned));
  s.imu.max_age = reader.number("imu_max_age_s", "s", kAge);
}

CrankSensor readCrankSensor(ParameterReader& reader) {
  constexpr NumberRule kNotNegative = NumberRule::notNegative();
  const std::size_t problems_before = reader.problems().size();
  CrankSensorPlace place;
  place.zero = reader.number("crank_zero_rad", "rad", NumberRule::within(-1e6, 1e6));
  place.direction = static_cast<int>(reader.integer("crank_direction", "", -1, 1));
  place.ratio = reader.number("crank_ratio", "", NumberRule::within(1e-3, 1e3));
  place.eccentricity[0] = reader.number("crank_eccentricity_1_rad", "rad", kNotNegative);
  place.eccentricity_phase[0] = reader.number("crank_eccentricity_1_phase_rad", "rad", kTurned);
  place.eccentricity[1] = reader.number("crank_eccentricity_2_rad", "rad", kNotNegative);
  place.eccentricity_phase[1] = reader.number("crank_eccentricity_2_phase_rad", "rad", kTurned);
  if (reader.problems().size() != problems_before) return {};
  const Checked<CrankSensor> sensor = CrankSensor::make(place);
  for (const std::string& problem : sensor.problems) reader.addProblem(problem);
  return sensor.value.value_or(CrankSensor());
}

}  // namespace

PipelineSettings readPipelineSettings(ParameterReader& reader) {
  PipelineSettings s;
  const std::optional<Level> level = reader.choice("level", kLevelChoices);
  s.choose_level = !level;
  s.level = level.value_or(Level::kLinkage);
  s.tolerance = reader.number("tolerance", "", kPart);
  s.turn_rate = reader.number("turn_rate_Hz", "Hz", NumberRule::within(0.01, 100.0));
  s.output = reader.choice("output", kOutputNames);
  s.output_rate = reader.number("output_rate_Hz", "Hz", kOutputRate);
  s.crank_joint = reader.text("crank_joint");
  s.hull_frame = reader.text("hull_frame");
  s.pitch_joints = reader.names("pitch_joints");
  s.pitch_signs = reader.signs("pitch_signs");
  if (!s.pitch_signs.empty() && s.pitch_signs.size() != s.pitch_joints.size())
    reader.addProblem(format("pitch_signs: %zu numbers, must be one for each of the %zu pitch_joints, or none",
                             s.pitch_signs.size(), s.pitch_joints.size()));
  s.pitch_offset = reader.number("pitch_offset_rad", "rad", NumberRule::within(-3.2, 3.2));
  s.hull_pitch = reader.number("hull_pitch_rad", "rad", kTurned);
  s.gravity = reader.number("gravity_m_s2", "m/s2", NumberRule::within(0.0, 100.0));
  s.base.roll = reader.number("base_roll_rad", "rad", NumberRule::within(-1.0, 1.0));
  s.base.pitch = reader.number("base_pitch_rad", "rad", NumberRule::within(-1.0, 1.0));
  s.crank_sensor = readCrankSensor(reader);
  s.crank_zero_std = reader.number("crank_zero_std_rad", "rad", NumberRule::within(0.0, 1.0));
  s.crank_latency = reader.number("crank_latency_s", "s", NumberRule::within(0.0, 1.0));
  s.crank_latency_std = reader.number("crank_latency_std_s", "s", NumberRule::within(0.0, 1.0));
  s.crank_angle_resolution = reader.number("crank_angle_resolution_rad", "rad", NumberRule::within(0.0, 1.6));
  s.crank_angle_noise = reader.number("crank_angle_noise_rad", "rad", NumberRule::within(0.0, 1.0));
  s.crank_stamps = reader.choice("crank_stamps", kCrankStampsNames);
  s.crank_timing_noise = reader.number("crank_timing_noise_s", "s", NumberRule::within(0.0, 1.0));
  s.crank_speed_noise = reader.number("crank_speed_noise_rad_s", "rad/s", NumberRule::within(1e-3, 1e3));
  s.torque_walk = reader.number("torque_walk_rad_s2", "rad/s2/sqrt(s)", NumberRule::within(1e-3, 1e6));
  s.speed_walk = reader.number("speed_walk_rad_s", "rad/s/sqrt(s)", NumberRule::within(0.0, 1e3));
  s.inertia_walk = reader.number("inertia_walk", "1/sqrt(s)", NumberRule::within(0.0, 1.0));
  s.initial_torque_std = reader.number("initial_torque_std_rad_s2", "rad/s2", NumberRule::within(1e-3, 1e6));
  s.initial_inertia_std = reader.number("initial_inertia_std", "", NumberRule::within(0.0, 10.0));
  s.torque_std_part = reader.number("torque_std_part", "", NumberRule::within(0.0, 1.0));
  s.near_blow = kDegree * reader.number("near_blow_deg", "deg", NumberRule::within(0.0, 89.0));
  s.stale_after = reader.number("stale_after_s", "s", kAge);
  s.max_crank_speed = reader.number("max_crank_speed_rad_s", "rad/s", NumberRule::within(1.0, 1e4));
  s.withhold_above = reader.number("withhold_above", "", kPart);
  readBoom(reader, s);
  readHullMotion(reader, s);
  return s;
}

Eigen::Matrix3d rotationOf(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
          AngleAxisd(roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace hammer_loads
