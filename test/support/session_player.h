/// A working session of the simulated machine, played into a pipeline as its sensors tell it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "boom/booms.h"
#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "settings/temporary_file.h"
#include "support/constants.h"
#include "support/imu_on_hull.h"
#include "support/known_zero.h"

namespace hammer_loads::test {

constexpr double kSessionWorks = 2.0;  ///< [s]: from then on the machine strikes
constexpr double kSessionEnd = 5.0;    ///< [s]

/// The shipped settings with the shipped boom, and with the keys in `text` over them. Unless `text` has others, the
/// level is rocker, since the machine of the sessions has a massless crank and rod, the hull is held, and the encoder's
/// zero is known as by `calibrate`.
inline Settings settingsWith(const std::string& text, bool boom_file = true) {
  const TemporaryFile given(text);
  const TemporaryFile level(std::string("level: rocker\nhull_motion: fixed\n") + kKnownZeroYaml);
  std::vector<std::string> files{level.path(), given.path()};
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
struct Player : accuracy::SessionPlayer {
  explicit Player(const Settings& settings, bool with_boom = true, const simulation::Session& played = session())
      : SessionPlayer(settings.mechanism, settings.pipeline, with_boom ? settings.boom : std::nullopt, played) {}
};

/// What a unit reads on a resting hull of that pitch [rad].
inline ImuReading atRest(double pitch, const HullImuSettings& mounting) {
  return readingOf({{kGravity * std::sin(pitch), -kGravity * std::cos(pitch)}}, mounting);
}

}  // namespace hammer_loads::test
