/// An IMU whose readings come late, with right stamps, on a hull that bounces on rock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/session_player.h"

namespace hammer_loads {
namespace {

/// Returns the largest hull acceleration that a pipeline states, with readings that come `late` [s].
double greatestMotion(const simulation::Session& session, double late) {
  const Settings settings = test::settingsWith("boom: none\nhull_motion: imu\ndrive_reaction_ratio: 1.0\n", false);
  Pipeline pipeline(settings.mechanism, settings.pipeline);
  double greatest = 0.0;
  auto next = session.imu.begin();
  for (const simulation::CrankReading& reading : session.crank) {
    for (; next != session.imu.end() && next->stamp + std::llround(1e9 * late) <= reading.stamp; ++next)
      pipeline.hullImu(next->stamp, {Eigen::Vector3d(next->specific_force.data()), Eigen::Vector3d(next->rate.data())});
    pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    const Gravity& gravity = pipeline.hull().motion().motion.gravity;
    greatest = std::max({greatest, std::abs(gravity.x), std::abs(gravity.z)});
  }
  return greatest;
}

/// A prediction over many readings diverges: it stated up to 2800 m/s2.
TEST(LateImu, IsNotPredictedBeyondWhatTheHullDoes) {
  for (const double hold_down : {0.0, 1500.0}) {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.duration = 5.0;
    machine.hammer.drive_reaction_ratio = 1.0;
    machine.on_boom.on = true;
    machine.on_boom.rock = {3e7, 3.0, hold_down};
    machine.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
    const simulation::Session session = simulation::recordSession(machine);
    const double in_time = greatestMotion(session, 0.0);
    for (const double late : {0.02, 0.032, 0.038, 0.045}) {
      const double greatest = greatestMotion(session, late);
      std::printf("hold-down %.0f N: %.0f m/s2 in time, %.0f m/s2 %.0f ms late\n", hold_down, in_time, greatest,
                  1e3 * late);
      EXPECT_LT(greatest, 1.5 * in_time);
    }
  }
}

}  // namespace
}  // namespace hammer_loads
