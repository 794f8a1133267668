// Tests the pipeline with a hammer on rock. The rock supports the hull and loses contact at each recoil. The sensors
// present decide which loads are known.
#include <map>
#include <random>
#include <string>

#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using accuracy::BoomErrors;
using test::errorsOf;

constexpr char kByPressures[] = "hull_motion: model\nboom_stiffness: identified\n";
constexpr char kByImuToo[] = "hull_motion: imu\nboom_stiffness: identified\n";

struct Rock {
  double hold_down_force;   ///< [N]
  double stiffness;         ///< [N/m]
  double oil{1.0};          ///< stiffness of the oil over the boom file's [-]
  unsigned pose{};          ///< 0: pose of the other sessions; else seed of a drawn one
  double pressures{500.0};  ///< rate of the pressures [Hz]
  friend std::ostream& operator<<(std::ostream& out, const Rock& r) {
    return out << r.hold_down_force << " N on " << r.stiffness << " N/m, oil " << r.oil << ", pose " << r.pose;
  }
};

simulation::MachineSettings machineOn(const Rock& rock) {
  simulation::MachineSettings m = test::machineOnBoom(rock.oil, 50.0);
  m.on_boom.rock = {rock.stiffness, 3.0, rock.hold_down_force};
  m.on_boom.pressures.rate = rock.pressures;
  if (rock.pose == 0) return m;
  std::mt19937 random(rock.pose);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  m.boom[1].mean = between(-0.75, -0.15), m.boom[2].mean = between(0.7, 1.5);
  m.boom[3].mean = between(-0.35, 0.35) - m.boom[1].mean - m.boom[2].mean;
  return m;
}

const simulation::Session& sessionOn(const Rock& rock) {
  static std::map<std::string, simulation::Session> recorded;
  const std::string key =
      format("%g %g %g %u %g", rock.hold_down_force, rock.stiffness, rock.oil, rock.pose, rock.pressures);
  const auto [at, is_new] = recorded.try_emplace(key);
  if (is_new) at->second = simulation::recordSession(machineOn(rock));
  return at->second;
}

class OnRock : public testing::TestWithParam<Rock> {};

void expectLoads(const BoomErrors& e) {
  EXPECT_LT(e.worstTorque(), 0.02);
  EXPECT_LT(e.worstSection(), 0.04);
  EXPECT_GT(e.leastCorrelation(), 0.99);
  EXPECT_LT(std::abs(e.energy()), 0.02);
  EXPECT_GT(e.covered(), 0.85);
  EXPECT_GT(e.sectionsCovered(), 0.85);
  EXPECT_GT(e.part(e.lost_as_shown), 0.8);
  EXPECT_EQ(e.unknown, 0U);
  EXPECT_FALSE(e.warnedOf("rock"));
}

TEST_P(OnRock, PressuresShowWhatTheBoomCarries) {
  const simulation::Session& session = sessionOn(GetParam());
  const BoomErrors e = errorsOf("pressures", session, kByPressures, {false, true});
  expectLoads(e);
  EXPECT_LT(e.contact.rmsOfRange(), 0.2) << "a landing is over before it has moved the oil";
  EXPECT_LT(e.moment.rms(), 0.06);
}

TEST_P(OnRock, PressuresAndImuShowTheRocksForceToo) {
  const simulation::Session& session = sessionOn(GetParam());
  const BoomErrors e = errorsOf("pressures and imu", session, kByImuToo, {true, true});
  expectLoads(e);
  EXPECT_LT(e.contact.rmsOfRange(), 0.05);
  EXPECT_GT(e.contact.correlation(), 0.95);
  EXPECT_LT(e.moment.rms(), 0.02);
}

/// Without the rock's force up to nine tenths of the torques would be missing.
TEST_P(OnRock, AnImuAloneShowsThatTheRocksForceIsNotKnown) {
  const simulation::Session& session = sessionOn(GetParam());
  const BoomErrors e = errorsOf("imu", session, kByImuToo, {true, false});
  EXPECT_GT(e.part(e.unknown), 0.95);
  EXPECT_GT(e.part(e.withheld), 0.99);
  EXPECT_TRUE(e.warnedOf("rock"));
  EXPECT_TRUE(e.warnedOf("boom loads"));
  EXPECT_LT(e.moment.rms(), 0.025) << "the hammer's own loads are as ever";
  EXPECT_LT(std::abs(e.energy()), 0.02);
  EXPECT_NEAR(
      e.frequency,
      simulation::HammerOnBoom(machineOn(GetParam())).frequencies(test::kJudgedTo)[0] / std::sqrt(GetParam().oil), 0.05)
      << "as the boom file gives it: nothing is learned from a hull that bounces";
}

INSTANTIATE_TEST_SUITE_P(PressForces, OnRock,
                         testing::Values(Rock{0.0, 3e7}, Rock{1500.0, 1e8, 1.0, 11}, Rock{4000.0, 1e7, 0.7, 12},
                                         Rock{12000.0, 3e7, 1.4, 13}));

/// Pressures come every 5 ms and landings last 10 ms: the torques follow the vibration between readings.
TEST(OnRockSession, PressuresAt200HzAreEnough) {
  const simulation::Session session = simulation::recordSession(machineOn({4000.0, 3e7, 1.0, 0, 200.0}));
  const BoomErrors pressures = errorsOf("200 Hz", session, kByPressures, {false, true});
  EXPECT_LT(pressures.worstTorque(), 0.05);
  EXPECT_LT(pressures.worstSection(), 0.04);
  EXPECT_GT(pressures.covered(), 0.85);
  expectLoads(errorsOf("200 Hz and imu", session, kByImuToo, {true, true}));
}

/// A measured force of the rock is dropped when its sensors fall silent, and is back with them.
TEST(OnRockSession, ARockThatIsNoLongerMeasuredIsForgotten) {
  const simulation::Session& session = sessionOn({4000.0, 3e7});
  test::Player player(test::settingsWith(std::string("boom: compliant\n") + kByPressures), true, session);
  player.imu_speaks = false;
  bool measured = false;
  double contact = 0.0;
  const auto look = [&](double, const SampleResult& result) {
    ASSERT_NE(result.boom, nullptr);
    measured = result.boom->measured;
    contact = result.boom->contact.force.norm();
    ASSERT_TRUE(result.boom->loads.total.allFinite());
  };
  player.playTo(5.0, look);
  EXPECT_TRUE(measured);
  player.pressures_speak = false;
  player.playTo(7.0, look);
  EXPECT_FALSE(measured);
  EXPECT_EQ(contact, 0.0);
  EXPECT_EQ(player.pipeline.boom()->boom().vibration().contact(), 0.0);
  player.pressures_speak = true;
  player.playTo(test::kJudgedTo, look);
  EXPECT_TRUE(measured);
}

/// The boom's loads are withheld while the hammer works and the rock's force is not known.
TEST(OnRockSession, WithheldLoadsComeBackWithPressuresAndAtRest) {
  simulation::MachineSettings stops = machineOn({4000.0, 3e7});
  stops.drive.stop_time = 7.0;
  const simulation::Session ends = simulation::recordSession(stops);
  for (const bool at_rest : {false, true}) {
    test::Player player(test::settingsWith(std::string("boom: compliant\n") + kByImuToo), true,
                        at_rest ? ends : sessionOn({4000.0, 3e7}));
    player.pressures_speak = false;
    std::map<bool, int> samples;  // withheld or not
    const auto look = [&](double, const SampleResult& result) { ++samples[result.boom->useless]; };
    player.playTo(5.0, look);
    samples.clear();
    player.playTo(6.9, look);
    EXPECT_EQ(samples[false], 0) << "of " << samples[true];
    player.pressures_speak = !at_rest;
    player.playTo(9.0, look);
    samples.clear();
    player.playTo(test::kJudgedTo, look);
    EXPECT_EQ(samples[true], 0) << "of " << samples[false] << (at_rest ? " at rest" : " with pressures");
    EXPECT_GT(player.pipeline.boom()->useless(), 1800U);
  }
}

/// Without a vibration model, torques follow the line through the last two readings.
TEST(OnRockSession, ARigidBoomTakesMeasuredTorquesToo) {
  const simulation::Session& session = sessionOn({4000.0, 3e7});
  test::Player player(test::settingsWith("boom: rigid\n"), true, session);
  player.imu_speaks = false;
  accuracy::SignalError torque;
  std::size_t i = 0;
  player.playTo(test::kJudgedTo, [&](double time, const SampleResult& result) {
    const simulation::OnBoomTruth& truth = session.on_boom[i++];
    if (time < test::kJudgedFrom) return;
    ASSERT_TRUE(result.boom->measured);
    ASSERT_GT(result.boom->deviations.torque[1], 0.0);
    for (int j = 0; j < 3; ++j) torque.add(result.boom->loads.total[j + 1], -truth.hold[j]);
  });
  EXPECT_LT(torque.rms(), 0.02);
}

/// With the correct oil stiffness in the file, the rock's force is found without identification.
TEST(OnRockSession, TheOilMayBeAsGiven) {
  const simulation::Session& session = sessionOn({4000.0, 3e7});
  expectLoads(errorsOf("as given", session, "hull_motion: model\nboom_stiffness: given\n", {false, true}));
  EXPECT_GT(errorsOf("without pressures", session, "hull_motion: model\n", {}).worstTorque(), 0.3)
      << "what pressures are for";
}

}  // namespace
}  // namespace hammer_loads
