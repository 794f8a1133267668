// One cylinder with softer oil than the others: identified from an IMU alone and named in the warning.
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using accuracy::BoomErrors;
using accuracy::SensorsOnBoom;

constexpr char kImu[] = "boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n";

/// Draws pose and common stiffness of the oil. oil: further factor of each cylinder, relative to the file.
simulation::MachineSettings drawnMachine(unsigned seed, std::array<double, 3> oil) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const test::Pose pose = test::drawnPose(between);
  simulation::MachineSettings m = test::machineOnBoom(between(0.8, 1.25), 50.0, pose);
  m.seed = 700 + seed;
  m.on_boom.cylinder_oil = oil;
  return m;
}

struct FoundOil {
  BoomErrors errors;
  std::array<std::optional<Vibration::IdentifiedOil>, 3> oil;
  std::string named, others;  ///< text of "cylinder stiffness"; keys of all other warnings
};

FoundOil findOil(const simulation::MachineSettings& machine, const std::string& keys, const SensorsOnBoom& sensors) {
  const simulation::Session session = simulation::recordSession(machine);
  const Settings settings = test::withExactHammer(test::settingsWith(keys));
  test::Player player(settings, true, session);
  player.imu_speaks = sensors.imu, player.pressures_speak = sensors.pressures;
  FoundOil found;
  std::size_t i = 0;
  player.playTo(test::kJudgedTo, [&](double time, const SampleResult& result) {
    const simulation::OnBoomTruth& truth = session.on_boom[i++];
    if (time < test::kJudgedFrom || !result.isPublished()) return;
    ASSERT_TRUE(result.boom != nullptr && !result.boom->fault) << time;
    found.errors.addSample(truth, result);
  });
  for (std::size_t k = 0; k < 3; ++k) found.oil[k] = player.pipeline.boom()->boom().vibration().identifiedOil(k);
  for (const Warning& warning : warningsOf(player.pipeline)) {
    if (std::string(warning.key) == "cylinder stiffness") {
      found.named = warning.text;
    } else {
      found.others += std::string(warning.key) + "; ";
    }
  }
  return found;
}

class SoftCylinder : public testing::TestWithParam<std::size_t> {};

TEST_P(SoftCylinder, IsLearnedFromAnImuAloneAndNamed) {
  const std::size_t cylinder = GetParam();
  for (const unsigned seed : {1U, 3U}) {
    std::array<double, 3> oil{1.0, 1.0, 1.0};
    oil[cylinder] = 1.0 / 3.0;
    const FoundOil found = findOil(drawnMachine(seed, oil), kImu, {true, false});
    EXPECT_LT(found.errors.worstTorque(), 0.15) << seed;
    EXPECT_GT(found.errors.covered(), 0.85) << seed;
    EXPECT_EQ(found.named.rfind(std::string(simulation::kBoomCylinders[cylinder]) + ": ", 0), 0U) << found.named;
    EXPECT_NE(found.named.find("softer"), std::string::npos) << found.named;
    EXPECT_EQ(found.others, "") << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, SoftCylinder, testing::Values(0U, 1U, 2U));

/// A stiffness within the boom file's standard deviation is no finding, one beyond it is.
TEST(SoftCylinder, IsNamedByWhatTheBoomFileAllowsFor) {
  const simulation::MachineSettings machine = drawnMachine(2, {1.0, 0.85, 1.1});
  EXPECT_EQ(findOil(machine, kImu, {true, false}).named, "");
  std::string exact = kImu, wide = kImu;
  for (const char* name : simulation::kBoomCylinders) {
    exact += format("%s_stiffness_std: 0.01\n", name);
    wide += format("%s_stiffness_std: 0.5\n", name);
  }
  EXPECT_EQ(findOil(machine, exact, {true, false}).named.rfind("arm_cylinder: ", 0), 0U);
  EXPECT_EQ(findOil(drawnMachine(2, {1.0, 0.5, 1.0}), wide, {true, false}).named, "");
}

/// Seals damp the boom beside its oil and shift the apparent stiffness, whose standard deviation contains this shift.
/// Without friction the stiffness is known to some percent.
TEST(SoftCylinder, HasTheUncertaintyOfDampingBesideTheOil) {
  const std::array<double, 3> oil{1.0, 1.0, 2.2};
  int within = 0, all = 0;
  for (const unsigned seed : {1U, 2U}) {
    for (const double friction : {0.0, 0.05}) {
      simulation::MachineSettings machine = drawnMachine(seed, oil);
      machine.on_boom.seals.friction = friction;
      const FoundOil found = findOil(machine, kImu, {true, false});
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_TRUE(found.oil[k]) << seed;
        const double off = found.oil[k]->stiffer - std::log(machine.on_boom.oil_stiffness * oil[k]);
        std::printf("  seals %g: %.3f off, deviation %.3f\n", friction, off, found.oil[k]->deviation);
        if (friction == 0.0) {
          EXPECT_LT(found.oil[k]->deviation, 0.04) << seed;
        }
        if (friction > 0.0) within += std::abs(off) < 2.0 * found.oil[k]->deviation, ++all;
      }
    }
  }
  EXPECT_GE(within, 0.85 * all);
}

/// Pressures show the oil's force directly: they identify the same cylinder, and no stamps are reported as late.
TEST(SoftCylinder, IsNoLateStampOfPressures) {
  for (const bool imu : {false, true}) {
    const FoundOil found = findOil(drawnMachine(3, {1.0, 1.0, 0.4}), kImu, {imu, true});
    EXPECT_LT(found.errors.worstTorque(), 0.04) << imu;
    EXPECT_GT(found.errors.covered(), 0.85) << imu;
    EXPECT_EQ(found.named.rfind("hammer_cylinder: ", 0), 0U) << found.named;
    EXPECT_EQ(found.others.find("stamps"), std::string::npos) << found.others;
  }
}

}  // namespace
}  // namespace hammer_loads
