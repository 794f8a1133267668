// Pressures through hoses, in coarse counts, at 100 Hz; stamps delayed by a bus, also those of the hull's IMU.
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

struct OverBus {
  double hose, bus;  // [s]
  test::Pose pose;
  double oil, hold_down_force;  // 0: the hull hangs free
};

accuracy::BoomErrors over(const OverBus& line, double rate, double count, unsigned seed = 73, bool imu = true) {
  simulation::MachineSettings machine = test::machineOnBoom(line.oil, 100.0, line.pose);
  machine.seed = seed;
  if (line.hold_down_force > 0.0) machine.on_boom.rock = {3e7, 3.0, line.hold_down_force};
  machine.on_boom.pressures.hose_lag = line.hose;
  machine.on_boom.pressures.rate = rate;
  machine.on_boom.pressures.count = count;
  machine.on_boom.bus_delay = line.bus;
  return test::errorsOf(
      "over a bus", simulation::recordSession(machine),
      std::string("boom_stiffness: identified\nlevel: rocker\nhull_motion: ") + (imu ? "imu\n" : "model\n"),
      {imu, true});
}

/// A hose attenuates an oscillation more at higher frequencies, which a delay does not. A line through two late
/// readings is extrapolated for longer than their interval.
TEST(SensorsOverBus, LeaveTheTorquesOfABoomThatIsIdentified) {
  for (const OverBus& line : {OverBus{6.2e-3, 1.75e-3, {-0.68, 1.55, -0.60}, 1.1, 0.0},
                              OverBus{6.5e-3, 1.2e-3, {-0.60, 1.40, -0.70}, 0.9, 3500.0}}) {
    SCOPED_TRACE(line.hose);
    const accuracy::BoomErrors e = over(line, 100.0, 39e3);
    EXPECT_LT(e.worstTorque(), 0.12);
    EXPECT_GT(e.covered(), 0.85);
    EXPECT_GT(e.leastWrenchCovered(), 0.85) << "by an IMU over the bus";
    EXPECT_TRUE(e.warnedOf("pressure stamps"));
    EXPECT_FALSE(e.warnedOf("rock"));
  }
}

/// Without an IMU nothing shows the hose's delay, and the torques are 10 to 95 % off.
TEST(SensorsOverBus, LeaveNoTorquesByPressuresAlone) {
  const OverBus line{5e-3, 1e-3, test::kUsualPose, 1.0, 0.0};
  const accuracy::BoomErrors alone = over(line, 100.0, 39e3, 73, false);
  EXPECT_GT(alone.part(alone.withheld), 0.95);
  EXPECT_TRUE(alone.warnedOf("boom loads"));
  EXPECT_GT(alone.leastWrenchCovered(), 0.85) << "the hammer's own loads are published";
  const accuracy::BoomErrors with_imu = over(line, 100.0, 39e3);
  EXPECT_EQ(with_imu.withheld, 0U);
  EXPECT_FALSE(with_imu.warnedOf("boom loads"));
}

/// Jittering stamps are not mistaken for a delay.
TEST(SensorsOverBus, JitterOfStampsIsLearned) {
  const accuracy::BoomErrors e = over({0.0, 1.5e-3, {-0.45, 1.00, -0.50}, 1.2, 0.0}, 500.0, 0.0);
  EXPECT_LT(e.worstTorque(), 0.03);
  EXPECT_GT(e.covered(), 0.9);
  EXPECT_FALSE(e.warnedOfPressures());
}

/// Two IMU readings that waited for one bus may have stamps in quick succession. The hull did not turn between them,
/// and no such turn may enter the crank's load.
TEST(SensorsOverBus, ReadingsThatCameTogetherTurnNoHull) {
  const accuracy::BoomErrors e = over({0.0, 1.751e-3, {-0.324, 1.021, -0.904}, 1.08, 0.0}, 500.0, 0.0, 901);
  EXPECT_LT(e.force_z.rms(), 0.01);
  EXPECT_LT(e.worstTorque(), 0.05);
  EXPECT_GT(e.covered(), 0.9);
}

/// The first readings of a unit turn no hull either. One of these machines had a crank acceleration of 1e7 rad/s2; with
/// its speed then uncertain, the filter restarted at each sample.
TEST(SensorsOverBus, TurnNoHullWithTheFirstReadings) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    simulation::MachineSettings machine = test::machineOnBoom(1.0, 100.0);
    machine.duration = 0.05;
    machine.seed = seed;
    machine.on_boom.bus_delay = 1.9e-3;
    const simulation::Session session = simulation::recordSession(machine);
    test::Player player(test::settingsWith("boom: compliant\nhull_motion: imu\n"), true, session);
    double greatest = 0.0;
    player.playTo(machine.duration, [&](double, const SampleResult& result) {
      greatest = std::max(greatest, std::abs(result.crank.acceleration));
    });
    EXPECT_GT(greatest, 0.0) << seed;
    EXPECT_LT(greatest, 1e4) << seed;
  }
}

}  // namespace
}  // namespace hammer_loads
