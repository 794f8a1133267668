/// Simulated machines as the calibration sees them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/constants.h"
#include "support/filter_settings.h"

namespace hammer_loads::test {

inline simulation::MachineSettings atWork(double seconds, double rate) {
  simulation::MachineSettings s = simulation::workingMo100();
  s.duration = seconds + 2.0;
  s.drive.stop_time = seconds + 10.0;
  s.crank.rate = rate;
  return s;
}

inline std::vector<calibration::RecordedSample> recorded(const simulation::MachineSettings& s) {
  const simulation::Session session = simulation::recordSession(s);
  std::vector<calibration::RecordedSample> samples;
  for (const simulation::CrankReading& reading : session.crank) {
    const double time = 1e-9 * static_cast<double>(reading.stamp - s.start_stamp);
    samples.push_back({time, reading.angle, reading.speed, simulation::hullGravity(s, std::max(time, 0.0))});
  }
  return samples;
}

inline calibration::CalibrationBasis basisOf(const Mechanism& mechanism) {
  return {mechanism, Level::kRocker, filterSettings()};
}

inline Mechanism mechanismOf(const simulation::MachineSettings& s, double guess = 1.0) {
  HammerParameters p = s.hammer;
  p.drive_inertia = guess * s.drive.inertia;
  return *Mechanism::make(p).value;
}

/// Returns null if the key is not found.
inline const calibration::Estimate* find(const calibration::Calibration& c, const std::string& key) {
  const auto at = std::find_if(c.estimates.begin(), c.estimates.end(),
                               [&](const calibration::Estimate& e) { return e.key == key; });
  return at == c.estimates.end() ? nullptr : &*at;
}

}  // namespace hammer_loads::test
