// The pipeline on a machine whose hull hangs on its boom: an unseen pose, a boom that moves, oil 30 % off, sensors with
// rates of their own. Joint sensors see the vibration.
#include <gtest/gtest.h>

#include "support/error_of_signal.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using simulation::OnBoomTruth;
using simulation::Session;
using test::Error;

constexpr double kBegin = 6.0, kEnd = 10.0;  ///< judged [s]: the machine works from 2 s on

simulation::MachineSettings machine(double oil, double joint_rate) {
  simulation::MachineSettings m = simulation::workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.duration = kEnd;
  m.drive.stop_time = 1e9;
  m.seed = 41;
  m.boom[1].mean = -0.45, m.boom[2].mean = 1.00, m.boom[3].mean = -0.50;
  m.joint_rate = joint_rate;
  m.joint_noise = 1e-4;
  m.on_boom.on = true;
  m.on_boom.oil_stiffness = oil;
  m.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
  m.on_boom.pressures = {500.0, 2e4, 6e6};
  return m;
}

struct SessionMisses {
  Error force_z, moment, torque[3], section[3];
  std::size_t samples{}, refused{}, within{}, blows{};
  double energy{};     ///< mean, relative
  double frequency{};  ///< of the lowest mode at the end [Hz]

  double worstTorque() const { return std::max({torque[0].rms(), torque[1].rms(), torque[2].rms()}); }
  double worstSection() const {
    return std::max({section[0].rmsOfRange(), section[1].rmsOfRange(), section[2].rmsOfRange()});
  }
  double leastCorrelation() const {
    return std::min({section[0].correlation(), section[1].correlation(), section[2].correlation()});
  }
  double covered() const { return static_cast<double>(within) / static_cast<double>(3 * samples); }
  void print(const std::string& name) const {
    std::printf(
        "%s: Fz %.2f|%.2f  My %.2f  torques %.2f %.2f %.2f  sections %.2f %.2f %.2f (correlation %.4f)  "
        "energy %.2f  covered %.0f %%  %.2f Hz\n",
        name.c_str(), 100 * force_z.rmsOfLargest(), 100 * force_z.worstOfLargest(), 100 * moment.rms(),
        100 * torque[0].rms(), 100 * torque[1].rms(), 100 * torque[2].rms(), 100 * section[0].rmsOfRange(),
        100 * section[1].rmsOfRange(), 100 * section[2].rmsOfRange(), leastCorrelation(), 100 * energy, 100 * covered(),
        frequency);
  }
};

struct SensorsOnBoom {
  bool imu{}, pressures{};
};

void addBlows(const Session& session, const SampleResult& result, SessionMisses& e) {
  for (std::size_t k = 0; k < result.turn_ends; ++k) {
    const double time = seconds(result.ends[k].stamp - simulation::workingMo100().start_stamp);
    for (const simulation::BlowTruth& blow : session.blows) {
      if (std::abs(blow.time - time) > 0.005) continue;
      e.energy += result.ends[k].blow.energy / blow.strike.energy - 1.0;
      ++e.blows;
    }
  }
}

void addSample(const OnBoomTruth& t, const SampleResult& result, SessionMisses& e) {
  ++e.samples;
  e.force_z.add(result.wrench.force_z, t.load.force_z);
  e.moment.add(result.wrench.torque_y, t.load.torque_y + t.drive_reaction_y);
  const BoomState& boom = *result.boom;
  for (int j = 0; j < 3; ++j) {
    const double weight = boom.loads.weight[j + 1], total = boom.loads.total[j + 1];
    e.torque[j].add(total - weight, -t.hold[j] - weight);
    e.within += std::abs(total + t.hold[j]) <= 2.0 * boom.deviations.torque[j + 1];
  }
  for (std::size_t s = 0; s < 3; ++s) e.section[s].add(boom.steel.section[s].torque.y(), t.cut[s].torque_y);
}

SessionMisses errorsOf(const std::string& name, const Session& session, const std::string& parameters,
                       const SensorsOnBoom& sensors) {
  test::Player player(test::settingsWith("boom: compliant\n" + parameters), true, session);
  player.imu_speaks = sensors.imu, player.pressures_speak = sensors.pressures;
  SessionMisses e;
  std::size_t i = 0;
  player.playTo(kEnd, [&](double time, const SampleResult& result) {
    const OnBoomTruth& truth = session.on_boom[i++];
    if (time < kBegin) return;
    addBlows(session, result, e);
    const bool known = !result.refusal && result.boom != nullptr && !result.boom->fault;
    if (known) {
      addSample(truth, result, e);
      e.frequency = result.boom->frequency[0];
    }
    e.refused += !known;
  });
  e.energy /= static_cast<double>(std::max<std::size_t>(1, e.blows));
  e.print(name);
  EXPECT_EQ(e.refused, 0U) << name;
  EXPECT_GT(e.blows, 15U) << name;
  return e;
}

constexpr char kModel[] = "hull_motion: model\nboom_stiffness: given\n";
constexpr char kIdentified[] = "hull_motion: model\nboom_stiffness: identified\n";
constexpr char kByImu[] = "hull_motion: imu\nboom_stiffness: identified\n";

void expectAsTheTruth(const SessionMisses& e, const std::string& name) {
  EXPECT_LT(e.worstTorque(), 0.05) << name;
  EXPECT_LT(e.moment.rms(), 0.02) << name;
  EXPECT_LT(e.force_z.rmsOfLargest(), 0.006) << name;
  EXPECT_LT(e.force_z.worstOfLargest(), 0.04) << name;
  EXPECT_LT(e.worstSection(), 0.04) << name;
  EXPECT_GT(e.leastCorrelation(), 0.99) << name;
  EXPECT_LT(std::abs(e.energy), 0.02) << name;
  EXPECT_GT(e.covered(), 0.85) << name;
}

/// The second mode is twice the blow rate: of all poses one of the worst, where 0.1 % of stiffness is 1 % of torque.
TEST(OnBoomSession, TheRightOilNeedsNoMoreSensors) {
  const Session session = simulation::recordSession(machine(1.0, 50.0));
  const SessionMisses model = errorsOf("right oil", session, kModel, {});
  expectAsTheTruth(model, "right oil");
  EXPECT_LT(model.worstTorque(), 0.02);
  expectAsTheTruth(errorsOf("right oil, hull by imu", session, "hull_motion: imu\n", {true, false}), "imu");
}

/// Without a boom file the IMU alone knows that the hull leaves the rock.
TEST(OnBoomSession, TheImuTakesTheHullsOwnSpeedOutOfTheEnergy) {
  for (const double crank_rate : {1000.0, 100.0}) {
    simulation::MachineSettings m = machine(1.0, 50.0);
    m.crank.rate = crank_rate;
    m.on_boom.imu = {500.0, 0.05, 0.1, 0.2, 0.1, 0.003};
    const Session session = simulation::recordSession(m);
    const auto error = [&](const std::string& hull_motion) {
      test::Player player(test::settingsWith("boom: none\nhull_motion: " + hull_motion, false), false, session);
      SessionMisses e;  // of energy alone
      player.playTo(kEnd, [&](double time, const SampleResult& result) {
        if (time > kBegin) addBlows(session, result, e);
      });
      EXPECT_GT(e.blows, 15U);
      return e.energy / static_cast<double>(e.blows);
    };
    const double fixed = error("fixed"), imu = error("imu\nimu_x_m: 0.05\nimu_z_m: 0.1\nimu_pitch_rad: 0.2\n");
    std::printf("energy at %.0f Hz: %.2f %% on a hull taken as fixed, %.2f %% with its IMU\n", crank_rate,
                100.0 * fixed, 100.0 * imu);
    EXPECT_GT(fixed, 0.03) << "what there is to find";
    EXPECT_LT(std::abs(imu), 0.02);
  }
}

class WrongOil : public testing::TestWithParam<double> {};

TEST_P(WrongOil, IsMeasuredByImuAndByPressures) {
  const simulation::MachineSettings m = machine(GetParam(), 50.0);
  const Session session = simulation::recordSession(m);
  const SessionMisses given = errorsOf("as given", session, kModel, {});
  EXPECT_GT(given.worstTorque(), 0.5) << "what the others must do better";
  const double frequency = simulation::HammerOnBoom(m).frequencies(kEnd)[0];
  const SessionMisses imu = errorsOf("imu", session, kIdentified, {true, false});
  EXPECT_NEAR(imu.frequency / frequency, 1.0, 0.03);
  expectAsTheTruth(imu, "imu");
  expectAsTheTruth(errorsOf("hull by imu", session, kByImu, {true, false}), "hull by imu");
  const SessionMisses pressures = errorsOf("pressures", session, kIdentified, {false, true});
  EXPECT_NEAR(pressures.frequency / frequency, 1.0, 0.03);
  expectAsTheTruth(pressures, "pressures");
  expectAsTheTruth(errorsOf("all sensors", session, kByImu, {true, true}), "all sensors");
}

TEST_P(WrongOil, IsMeasuredByJointStatesAbove100Hz) {
  const simulation::MachineSettings m = machine(GetParam(), 400.0);
  const Session session = simulation::recordSession(m);
  const SessionMisses e = errorsOf("joint states", session, kIdentified, {});
  EXPECT_NEAR(e.frequency / simulation::HammerOnBoom(m).frequencies(kEnd)[0], 1.0, 0.03);
  expectAsTheTruth(e, "joint states");
}

/// Its own acceleration hides the vibration from all sensors but pressures: then nothing is learned from them.
TEST(OnBoomSession, ABoomThatIsDrivenFastKeepsTheModesAsGiven) {
  simulation::MachineSettings m = machine(1.0, 400.0);
  m.boom[1].amplitude = 0.15, m.boom[1].period = 6.0;
  m.boom[2].amplitude = 0.20, m.boom[2].period = 5.0;
  const Session session = simulation::recordSession(m);
  const SessionMisses given = errorsOf("driven, as given", session, kModel, {});
  const SessionMisses followed = errorsOf("driven, imu and joint states", session, kIdentified, {true, false});
  EXPECT_LT(followed.worstTorque(), 1.05 * given.worstTorque());
  EXPECT_GT(followed.covered(), 0.85);
  EXPECT_LT(errorsOf("driven, pressures", session, kIdentified, {false, true}).worstTorque(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(OnBoomSession, WrongOil, testing::Values(0.7, 1.4));

}  // namespace
}  // namespace hammer_loads
