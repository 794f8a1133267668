/// Settings of the computation of loads from samples: the content of config/pipeline.yaml. Its keys contain the units.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/crank/stamp_sequence.h"
#include "hammer_loads/linkage/level.h"

namespace hammer_loads {

/// Place of an inertial measurement unit on the hull.
struct HullImuSettings {
  Eigen::Vector3d position{0.0, 0.0, 0.0};                ///< from D, axes of hammer_hull [m]
  double position_std{};                                  ///< standard deviation of each coordinate [m]
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};  ///< from the unit's axes to those of hammer_hull
  double max_age{};  ///< largest age of the last reading [s], > 0; beyond it the motion is unknown
};

/// Returns the rotation by roll, pitch, yaw about fixed x, y, z [rad], as in a URDF origin.
Eigen::Matrix3d rotationOf(double roll, double pitch, double yaw);

class ParameterReader;

/// Kind of the published hull wrench.
enum class OutputKind {
  kInstantaneous,  ///< value at the stamp
  kMean,           ///< mean since the previous output: no impulse is lost at any rate
};

/// Words for `level`; auto selects the cheapest level within `tolerance`.
constexpr std::array<std::pair<const char*, std::optional<Level>>, 5> kLevelChoices{{{"pulse", Level::kPulse},
                                                                                     {"rocker", Level::kRocker},
                                                                                     {"linkage", Level::kLinkage},
                                                                                     {"elastic", Level::kElastic},
                                                                                     {"auto", std::nullopt}}};
/// Names of the levels with rigid links, for a machine without the spring of an elastic connecting rod.
constexpr std::array<std::pair<const char*, Level>, 3> kRigidLevelNames{
    {{"pulse", Level::kPulse}, {"rocker", Level::kRocker}, {"linkage", Level::kLinkage}}};
constexpr const char* nameOf(Level level) noexcept {
  for (const auto& [name, named] : kLevelChoices)
    if (named == level) return name;
  return "";
}
constexpr std::array<std::pair<const char*, CrankStamps>, 3> kCrankStampsNames{
    {{"auto", CrankStamps::kAuto}, {"header", CrankStamps::kHeader}, {"steady", CrankStamps::kSteady}}};

constexpr std::array<std::pair<const char*, OutputKind>, 2> kOutputNames{
    {{"instantaneous", OutputKind::kInstantaneous}, {"mean", OutputKind::kMean}}};
/// Models of the boom's response to the hammer.
enum class BoomModel {
  kNone,       ///< nothing of the boom is computed
  kRigid,      ///< the boom follows its joint states alone
  kCompliant,  ///< the boom also vibrates on the oil of its cylinders
  kAuto,       ///< compliant unless rigid is within rigid_tolerance for the last revolution's pulse
};

/// Source of the boom's own acceleration.
enum class BoomAcceleration {
  kNone,        ///< zero
  kDifference,  ///< difference of the joints' velocities
};

/// Sources of the modes' frequencies and damping.
enum class BoomStiffness {
  kGiven,       ///< values of the boom file
  kIdentified,  ///< identified from hull IMU, joint states above 100 Hz and cylinder pressures, if received
};

constexpr std::array<std::pair<const char*, BoomStiffness>, 2> kBoomStiffnessNames{
    {{"given", BoomStiffness::kGiven}, {"identified", BoomStiffness::kIdentified}}};
constexpr std::array<std::pair<const char*, BoomModel>, 4> kBoomModelNames{{{"none", BoomModel::kNone},
                                                                            {"rigid", BoomModel::kRigid},
                                                                            {"compliant", BoomModel::kCompliant},
                                                                            {"auto", BoomModel::kAuto}}};
constexpr std::array<std::pair<const char*, BoomAcceleration>, 2> kBoomAccelerationNames{
    {{"none", BoomAcceleration::kNone}, {"difference", BoomAcceleration::kDifference}}};

/// Source of the hull's own motion.
enum class HullMotionSource {
  kFixed,       ///< the hull is held; weight by pitch
  kUnmeasured,  ///< weight by pitch; the hull's own motion enters the standard deviation
  kImu,         ///< motion that the hull's IMU reports
  kModel,       ///< vibration of the compliant boom
};

constexpr std::array<std::pair<const char*, HullMotionSource>, 4> kHullMotionNames{
    {{"unmeasured", HullMotionSource::kUnmeasured},
     {"fixed", HullMotionSource::kFixed},
     {"imu", HullMotionSource::kImu},
     {"model", HullMotionSource::kModel}}};

struct PipelineSettings {
  Level level{};        ///< level in force; for `auto`, the selected one
  bool choose_level{};  ///< true if the file has `auto`
  double tolerance{};   ///< difference of a level over the uncertainty by the hammer's constants, for `auto` [-], > 0
  double turn_rate{};   ///< rate of the working revolution that `auto` considers [Hz], > 0
  OutputKind output{};
  double output_rate{};                   ///< rate of hull_wrench [Hz]; 0: one per crank sample
  std::string hull_frame{"hammer_hull"};  ///< frame of the wrench if no boom file names its tip
  std::string crank_joint;                ///< joint whose position is the crank angle
  std::vector<std::string> pitch_joints;  ///< joints whose angles add up to the hull's pitch
  std::vector<int> pitch_signs;           ///< sign of each of them, 1 or -1: direction about +y; empty: all 1
  double pitch_offset{};                  ///< hull's pitch with all of them at zero [rad]
  std::optional<Chain> pitch_chain;       ///< chain to the hull or the last pitch joint's link, if a robot description
                                          ///< has it and there is no boom; its axes and zeros are used for the weight
  double hull_pitch{};                    ///< hull's pitch until every pitch joint was received [rad]
  HullMotionSource hull_motion{};
  HullImuSettings imu;              ///< place of the IMU
  double gravity{};                 ///< [m/s2], >= 0
  BaseTilt base;                    ///< inclination of the ground that the machine stands on
  CrankSensor crank_sensor;         ///< mounting of the crank's sensor
  double crank_zero_std{};          ///< standard deviation of its zero until revolutions show it [rad of reading], >= 0
  double crank_latency{};           ///< header stamp less the instant of the measurement [s], >= 0
  double crank_latency_std{};       ///< standard deviation of the crank's latency [s], >= 0
  double crank_angle_resolution{};  ///< encoder count [rad], >= 0; 0: identified from the readings
  double crank_angle_noise{};       ///< standard deviation in addition to the count [rad], >= 0
  CrankStamps crank_stamps{};       ///< source of the samples' instants
  double crank_timing_noise{};      ///< standard deviation of a sample's stamp, initial value [s], >= 0
  double crank_speed_noise{};       ///< standard deviation of a measured speed [rad/s], > 0
  double torque_walk{};             ///< random walk of the net torque per rocker inertia about D [rad/s2/sqrt(s)], > 0
  double speed_walk{};              ///< random walk of the speed [rad/s/sqrt(s)], >= 0
  double inertia_walk{};            ///< random walk relative to the drive inertia [1/sqrt(s)], >= 0
  double initial_torque_std{};      ///< standard deviation of the net torque per rocker inertia about D [rad/s2], > 0
  double initial_inertia_std{};     ///< standard deviation relative to the drive inertia [-], >= 0
  double torque_std_part{};         ///< part of the torque's standard deviation that enters the wrench's [-], in [0, 1]
  double near_blow{};               ///< transmission angle below which pin forces are flagged [rad], in (0, pi/2)
  double stale_after{};             ///< longest time without a crank sample; then nothing is published [s], > 0
  double max_crank_speed{};         ///< speed above which a sample is implausible [rad/s], > 0
  double withhold_above{};          ///< largest predicted error of the wrench over the revolution's peak [-], > 0
  BoomModel boom{};
  BoomAcceleration boom_acceleration{};
  BoomStiffness boom_stiffness{};
  double joint_max_age{};                      ///< largest time from a crank sample to a joint's nearest state [s], > 0
  std::vector<std::string> boom_wrench_links;  ///< links and TF frames at which the hull wrench is published as well
  double tf_max_wait{};                        ///< longest wait of a wrench for the transform to its frame [s], > 0
};

/// Returns true if readings of the hull's IMU are used.
inline bool needsImu(const PipelineSettings& settings) {
  return settings.hull_motion == HullMotionSource::kImu || settings.boom_stiffness == BoomStiffness::kIdentified;
}

/// Reads the settings, which are usable only if the reader has no problem.
PipelineSettings readPipelineSettings(ParameterReader& reader);

}  // namespace hammer_loads
