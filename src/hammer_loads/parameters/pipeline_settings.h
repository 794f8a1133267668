/// How samples become loads: what config/pipeline.yaml sets. Keys there carry the units.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/linkage/level.h"

namespace hammer_loads {

class ParameterReader;

/// Where the crank's acceleration comes from.
enum class CrankEstimator {
  kMechanism,   ///< Kalman filter on the mechanism
  kDifference,  ///< difference of measured speeds
  kNone,        ///< zero, as P0 assumes
};

constexpr std::array<std::pair<const char*, Level>, 3> kLevelNames{
    {{"pulse", Level::kPulse}, {"rocker", Level::kRocker}, {"linkage", Level::kLinkage}}};
constexpr std::array<std::pair<const char*, CrankEstimator>, 3> kCrankEstimatorNames{
    {{"mechanism", CrankEstimator::kMechanism},
     {"difference", CrankEstimator::kDifference},
     {"none", CrankEstimator::kNone}}};

struct PipelineSettings {
  Level level{};
  CrankEstimator crank_estimator{};
  std::string crank_joint;                ///< joint whose position is the crank angle
  std::vector<std::string> pitch_joints;  ///< joints whose angles add up to the hull's pitch
  double hull_pitch{};                    ///< until every pitch joint has been heard [rad]
  double gravity{};                       ///< [m/s2], >= 0
  double crank_angle_resolution{};        ///< encoder count [rad], > 0
  double crank_angle_noise{};             ///< standard deviation beside the count [rad], >= 0
  double crank_speed_noise{};             ///< standard deviation of a measured speed [rad/s], > 0
  double torque_walk{};                   ///< of the net torque per rocker inertia about D [rad/s2/sqrt(s)], > 0
  double speed_walk{};                    ///< [rad/s/sqrt(s)], >= 0
  double inertia_walk{};                  ///< relative to the drive inertia [1/sqrt(s)], >= 0
  double initial_torque_deviation{};      ///< of the net torque per rocker inertia about D [rad/s2], > 0
  double initial_inertia_deviation{};     ///< relative to the drive inertia [-], >= 0
  double near_blow{};                     ///< transmission angle below which pin forces are flagged [rad], in (0, pi/2)
  double stale_after{};                   ///< no crank sample for longer: nothing is published [s], > 0
  double max_crank_speed{};               ///< a faster sample is implausible [rad/s], > 0
  double withhold_above{};                ///< predicted error of the wrench over the turn's peak [-], > 0
};

/// Usable only if the reader got no problem.
PipelineSettings readPipelineSettings(ParameterReader& reader);

}  // namespace hammer_loads
