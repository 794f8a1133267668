/// A working session of the simulated machine, played into a pipeline as its sensors tell it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "boom/booms.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "settings/temporary_file.h"
#include "support/constants.h"
#include "support/imu_on_hull.h"

namespace hammer_loads::test {

constexpr double kSessionWorks = 2.0;  ///< [s]: from then on the machine strikes
constexpr double kSessionEnd = 5.0;    ///< [s]

/// The shipped settings with the shipped boom, and with the keys in `text` over them.
inline Settings settingsWith(const std::string& text, bool boom_file = true) {
  const TemporaryFile given(text);
  std::vector<std::string> files{given.path()};
  if (boom_file) files.insert(files.begin(), configDirectory() + "/boom_eo2621.yaml");
  const Checked<Settings> settings = loadFiles(configDirectory(), files, shippedUrdf());
  if (!settings.value) throw std::runtime_error(settings.problems.front());
  return *settings.value;
}

inline simulation::Session record(const std::vector<simulation::CrankSensorSettings::Interval>& drop_outs = {}) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = kSessionEnd;
  machine.crank.drop_outs = drop_outs;
  return simulation::recordSession(machine);
}

inline const simulation::Session& session() {
  static const simulation::Session recorded = record();
  return recorded;
}

/// Plays a session's sensors into a pipeline in the order of their stamps.
class Player {
 public:
  explicit Player(const Settings& settings, bool with_boom = true, const simulation::Session& played = session())
      : pipeline(settings.mechanism, settings.pipeline, with_boom ? settings.boom : std::nullopt), session_(played) {}

  /// Crank samples of times before `time` [s]; each(time, loads) for all of them.
  template <typename Each>
  void playTo(double time, const Each& each) {
    for (; crank_ < session_.crank.size() && session_.truth[crank_].time < time; ++crank_) {
      const simulation::CrankReading& reading = session_.crank[crank_];
      for (; joint_ < session_.joints.size() && session_.joints[joint_].stamp <= reading.stamp; ++joint_)
        if (joints_speak) tellJoints(session_.joints[joint_]);
      for (; imu_ < session_.imu.size() && session_.imu[imu_].stamp <= reading.stamp; ++imu_)
        if (imu_speaks) tellImu(session_.imu[imu_]);
      for (; pressure_ < session_.pressures.size() && session_.pressures[pressure_].stamp <= reading.stamp; ++pressure_)
        if (pressures_speak) tellPressures(session_.pressures[pressure_]);
      if (imu) pipeline.hullImu(reading.stamp, *imu);
      angle_[0] = reading.angle, speed_[0] = *reading.speed;
      each(session_.truth[crank_].time, pipeline.crankJoint(reading.stamp, crank_name_, angle_, speed_));
    }
  }

  Pipeline pipeline;
  bool joints_speak{true}, imu_speaks{true}, pressures_speak{true};
  std::optional<ImuReading> imu;  ///< told with each crank sample

 private:
  void tellJoints(const simulation::JointReading& reading) {
    std::copy(reading.position.begin(), reading.position.end(), position_.begin());
    std::copy(reading.velocity.begin(), reading.velocity.end(), velocity_.begin());
    pipeline.boomJoints(reading.stamp, joint_names_, position_, velocity_);
  }

  void tellImu(const simulation::HullImuReading& r) {
    pipeline.hullImu(
        r.stamp, {{r.specific_force[0], r.specific_force[1], r.specific_force[2]}, {r.rate[0], r.rate[1], r.rate[2]}});
  }
  void tellPressures(const simulation::PressureReading& r) {
    for (std::size_t i = 0; i < r.bore.size(); ++i) {
      pipeline.cylinderPressure(r.stamp, i, Chamber::kBore, r.bore[i]);
      pipeline.cylinderPressure(r.stamp, i, Chamber::kRod, r.rod[i]);
    }
  }

  const std::vector<std::string> crank_name_{"hammer_crank_joint"};
  const std::vector<std::string> joint_names_{simulation::kBoomJoints.begin(), simulation::kBoomJoints.end()};
  const simulation::Session& session_;
  std::size_t crank_{}, joint_{}, imu_{}, pressure_{};
  std::vector<double> angle_{0.0}, speed_{0.0}, position_ = std::vector<double>(4), velocity_ = position_;
};

/// What a unit reads on a resting hull of that pitch [rad].
inline ImuReading atRest(double pitch, const HullImuSettings& mounting) {
  return readingOf({{kGravity * std::sin(pitch), -kGravity * std::cos(pitch)}}, mounting);
}

}  // namespace hammer_loads::test
