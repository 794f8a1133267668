// Machines drawn at random whose one flaw is that their seals rub: nothing else may be named.
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using simulation::MachineSettings;

/// Pose, oil, seals of 0.5 to 2 % of the force; every second one presses its hull on rock.
MachineSettings rubbingMachine(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const test::Pose pose = test::drawnPose(between);
  MachineSettings m = test::machineOnBoom(between(0.75, 1.3), 50.0, pose);
  m.seed = 900 + seed;
  m.on_boom.seals.friction = between(0.005, 0.02);
  if (seed % 2 == 0) m.on_boom.rock = {between(1e7, 6e7), 3.0, between(3e3, 6e3)};
  return m;
}

constexpr double kSettled = 6.0;  ///< [s]: the machine works from 2 s on, the oil is sought until then

/// What is said of boom, rock, IMU and pressures at any time once the oil is found, without repetition.
std::string namesOf(const MachineSettings& machine, const simulation::Session& session, bool imu, bool pressures) {
  const Settings settings = test::withExactHammer(test::settingsWith(
      std::string("boom: compliant\nboom_stiffness: identified\nhull_motion: ") + (imu ? "imu\n" : "model\n")));
  test::Player player(settings, true, session);
  player.imu_speaks = imu, player.pressures_speak = pressures;
  std::string names;
  double next = 0.0;
  player.playTo(machine.duration, [&](double time, const SampleResult&) {
    if (time < std::max(next, kSettled)) return;
    next = time + 0.5;
    for (const Warning& warning : warningsOf(player.pipeline)) {
      const std::string key = warning.key;
      if (key != "eccentricity" && names.find(key) == std::string::npos) names += key + "; ";
    }
  });
  return names;
}

TEST(FalseNames, SealsThatRubAreNoLateStampNoRockAndNoExchange) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const MachineSettings machine = rubbingMachine(seed);
    const simulation::Session session = simulation::recordSession(machine);
    const bool on_rock = machine.on_boom.rock.stiffness > 0.0;
    EXPECT_EQ(namesOf(machine, session, false, true), "") << seed;
    EXPECT_EQ(namesOf(machine, session, true, true), "") << seed;
    EXPECT_EQ(namesOf(machine, session, true, false), on_rock ? "rock; " : "") << seed;
  }
}

}  // namespace
}  // namespace hammer_loads
