/// A session of the simulated machine, played into a pipeline as its sensors give it.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {

/// True load as it is published: with the drive's reaction.
inline Eigen::Vector3d wrenchOf(const simulation::CrankTruth& truth) {
  return {truth.load.force_x, truth.load.force_z, truth.load.torque_y + truth.drive_reaction_y};
}

/// In the order of the stamps. The session must live as long.
class SessionPlayer {
 public:
  SessionPlayer(const Mechanism& mechanism, const PipelineSettings& settings, const std::optional<Boom>& boom,
                const simulation::Session& session)
      : pipeline(mechanism, settings, boom), session_(session) {}

  /// Crank samples of times before `time` [s]; each(time, loads) for all of them.
  template <typename Each>
  void playTo(double time, const Each& each) {
    for (; crank_ < session_.crank.size() && session_.truth[crank_].time < time; ++crank_) {
      const simulation::CrankReading& reading = session_.crank[crank_];
      const auto upToHere = [&](const auto& readings, std::size_t& next, const auto& give) {
        for (; next < readings.size() && readings[next].stamp <= reading.stamp; ++next) give(readings[next]);
      };
      upToHere(session_.joints, joint_, [this](const auto& r) { giveJoints(r); });
      upToHere(session_.imu, imu_, [this](const auto& r) { giveImu(r); });
      upToHere(session_.pressures, pressure_, [this](const auto& r) { givePressures(r); });
      if (imu) pipeline.hullImu(reading.stamp, *imu);
      angle_[0] = reading.angle;
      speed_.resize(reading.speed ? 1 : 0);
      if (reading.speed) speed_[0] = *reading.speed;
      each(session_.truth[crank_].time, pipeline.crankJoint(reading.stamp, crank_name_, angle_, speed_));
    }
  }

  Pipeline pipeline;
  bool joints_speak{true}, imu_speaks{true}, pressures_speak{true};
  std::optional<ImuReading> imu;  ///< given with each crank sample

 private:
  void giveJoints(const simulation::JointReading& reading) {
    if (!joints_speak) return;
    std::copy(reading.position.begin(), reading.position.end(), position_.begin());
    std::copy(reading.velocity.begin(), reading.velocity.end(), velocity_.begin());
    pipeline.boomJoints(reading.stamp, joint_names_, position_, velocity_);
  }
  void giveImu(const simulation::HullImuReading& r) {
    if (!imu_speaks) return;
    pipeline.hullImu(
        r.stamp, {{r.specific_force[0], r.specific_force[1], r.specific_force[2]}, {r.rate[0], r.rate[1], r.rate[2]}});
  }
  void givePressures(const simulation::PressureReading& r) {
    for (std::size_t i = 0; i < r.bore.size() && pressures_speak; ++i) {
      pipeline.cylinderPressure(r.stamp, i, Chamber::kBore, r.bore[i]);
      pipeline.cylinderPressure(r.stamp, i, Chamber::kRod, r.rod[i]);
    }
  }

  const std::vector<std::string> crank_name_{"hammer_crank_joint"};
  const std::vector<std::string> joint_names_{simulation::kBoomJoints.begin(), simulation::kBoomJoints.end()};
  const simulation::Session& session_;
  std::size_t crank_{}, joint_{}, imu_{}, pressure_{};
  std::vector<double> angle_{0.0}, speed_{0.0};
  std::vector<double> position_ = std::vector<double>(simulation::kBoomJoints.size()), velocity_ = position_;
};

}  // namespace hammer_loads::accuracy
