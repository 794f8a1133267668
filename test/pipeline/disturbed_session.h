/// A machine that works for 8 s, its disturbed recording, and the resulting errors of the boom's loads.
#pragma once

#include <algorithm>
#include <cstdio>
#include <vector>

#include "pipeline/on_boom_session.h"

namespace hammer_loads::test {

using accuracy::BoomErrors;
using accuracy::SensorsOnBoom;
using simulation::Session;

constexpr double kDisturbed = 5.0, kGoesOn = 6.2;  // [s]
constexpr char kBoomGiven[] = "{boom: compliant, hull_motion: model}";
constexpr char kBoomIdentified[] = "{boom: compliant, hull_motion: model, boom_stiffness: identified}";
constexpr char kHullByImu[] = "{boom: compliant, hull_motion: imu, boom_stiffness: identified}";

inline simulation::MachineSettings disturbedMachine(bool on_rock = false) {
  simulation::MachineSettings m = machineOnBoom(1.0, 50.0);
  if (on_rock) m.on_boom.rock = {3e7, 3.0, 4000.0};
  m.drive.start_time = 0.1;
  m.duration = 8.0;
  return m;
}

inline BoomErrors errorsOf(const Session& session, const char* keys, const SensorsOnBoom& sensors, double from,
                           double to) {
  const Settings settings = accuracy::shippedBoom(keys);
  return accuracy::boomErrors(session, settings, sensors, from, to);
}

/// Expects loads that are withheld or within their deviations.
inline void expectHonest(const BoomErrors& e) {
  if (e.withheld == e.samples) return;
  EXPECT_GT(e.covered(), 0.85);
  EXPECT_GT(e.sectionsCovered(), 0.85);
}

/// Returns the first reading from an instant [s] on; later readings follow it.
template <typename Reading>
Reading* after(std::vector<Reading>& readings, double time) {
  const auto start = simulation::workingMo100().start_stamp;
  const auto at = std::find_if(readings.begin(), readings.end(),
                               [&](const Reading& r) { return 1e-9 * static_cast<double>(r.stamp - start) >= time; });
  return &*at;
}

template <typename Reading>
void silence(std::vector<Reading>& readings, double from, double to) {
  const auto at = [&](double time) { return readings.begin() + (after(readings, time) - readings.data()); };
  readings.erase(at(from), at(to));
}

}  // namespace hammer_loads::test
