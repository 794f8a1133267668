// The crank's lead by a zero that is off, in the delays that the mode identifier finds.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/boom_errors.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

/// A zero that is off makes a right IMU look late; one that is late as well is late by the rest alone [s].
TEST(CrankLead, IsThatOfTheZeroAndNoMore) {
  simulation::MachineSettings machine = test::machineOnBoom(1.0, 50.0);
  machine.crank.zero = 1.0 * kDegree;
  machine.drive.start_time = 0.1;
  machine.duration = 6.0;
  const simulation::Session right = simulation::recordSession(machine);
  const Settings settings =
      test::withExactHammer(accuracy::shippedBoom("{boom: compliant, hull_motion: model, boom_stiffness: identified}"));
  for (const double late : {0.0, 1e-3}) {
    simulation::Session session = right;
    for (simulation::HullImuReading& r : session.imu) r.stamp += std::llround(1e9 * late);
    test::Player player(settings, true, session);
    player.pressures_speak = false;
    player.playTo(machine.duration, [](double, const SampleResult&) {});
    EXPECT_NEAR(player.pipeline.boom()->boom().vibration().identifier()->delay(Clock::kImu), late, 0.3e-3);
  }
}

}  // namespace
}  // namespace hammer_loads
