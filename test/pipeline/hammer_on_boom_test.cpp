// The pipeline against a machine whose hull, boom, crank and flywheel move together: a truth of its own equations.
#include "hammer_loads/simulation/hammer_on_boom.h"

#include <gtest/gtest.h>

#include <random>

#include "hammer_loads/bench/signal_error.h"
#include "hammer_loads/simulation/session.h"
#include "support/constants.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using simulation::HammerOnBoom;
using simulation::OnBoomTruth;
using Error = accuracy::SignalError;
constexpr double kMillisecond = 1e-3, kRecordBegin = 3.0, kRecordEnd = 8.0;
using test::kMs;

struct Recording {
  std::vector<OnBoomTruth> truth;
  std::vector<simulation::BlowTruth> blows;
};

constexpr std::array<double, 3> kPose{-0.35, 1.20, -0.85};

const Recording& recording() {
  static const Recording recorded = [] {
    simulation::MachineSettings machine = simulation::workingMo100();
    machine.drive.stop_time = 1e9;
    machine.drive.start_time = 0.0, machine.drive.start_ramp = 0.5, machine.start_angle = 3.0;  // goes forward at once
    for (std::size_t i = 0; i < 3; ++i) machine.boom[i + 1] = {kPose[i], 0.0, 1.0, 0.0};
    HammerOnBoom hammer(machine);
    Recording r;
    for (int i = 1; i * kMillisecond < kRecordEnd; ++i) {
      hammer.advanceTo(i * kMillisecond);
      r.truth.push_back(hammer.truth());
    }
    r.blows = hammer.takeBlows();
    return r;
  }();
  return recorded;
}

/// Which sensors speak, and what they get wrong.
struct Sensors {
  bool imu{}, pressures{};
  double zero{};            ///< of the encoder [rad]
  double crank_noise{};     ///< of angle [rad], times 300 of speed [rad/s]
  double imu_noise{};       ///< [m/s2], a sixtieth of it [rad/s]
  double pressure_noise{};  ///< [Pa]
  bool joints{};            ///< at each sample, and see the vibration; else at 50 Hz where the operator holds them
};

/// Plays the machine's sensors into a pipeline; each(truth, result) for every sample after kRecordBegin.
template <typename Each>
void play(Pipeline& pipeline, const Sensors& sensors, const Each& each) {
  std::mt19937_64 random(7);
  const auto noise = [&](double size) { return size > 0.0 ? size * std::normal_distribution<>()(random) : 0.0; };
  const std::vector<std::string> names{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};
  int i = 0;
  for (const OnBoomTruth& t : recording().truth) {
    const StampNs stamp = 1000000000 + (++i) * kMs;
    const Eigen::Vector3d q = t.angles;
    if (sensors.joints) pipeline.boomJoints(stamp, names, {0.0, q[0], q[1], q[2]}, {});
    if (!sensors.joints && i % 20 == 1)
      pipeline.boomJoints(stamp, names, {0.0, kPose[0], kPose[1], kPose[2]}, {0.0, 0.0, 0.0, 0.0});
    if (sensors.imu)
      pipeline.hullImu(stamp, {{t.imu_x + noise(sensors.imu_noise), 0.0, t.imu_z + noise(sensors.imu_noise)},
                               {0.0, t.imu_rate + noise(sensors.imu_noise / 60.0), 0.0}});
    for (std::size_t c = 0; sensors.pressures && c < 3; ++c) {
      pipeline.cylinderPressure(stamp, c, Chamber::kBore, t.bore_pressure[c] + noise(sensors.pressure_noise));
      pipeline.cylinderPressure(stamp, c, Chamber::kRod, t.rod_pressure[c] + noise(sensors.pressure_noise));
    }
    const SampleResult& result =
        pipeline.crankSample(stamp, {std::remainder(t.angle + sensors.zero + noise(sensors.crank_noise), kTwoPi),
                                     t.speed + noise(300.0 * sensors.crank_noise)});
    if (t.time > kRecordBegin) each(t, result);
  }
}

struct Errors {
  Error force_z, moment, torque[3], section;
  std::size_t samples{}, blows{}, refused{}, within{};
  double covered() const { return static_cast<double>(within) / static_cast<double>(3 * samples); }
  double energy{};  ///< mean, relative
};

std::size_t sectionNamed(const Boom& boom, const std::string& name) {
  for (std::size_t i = 0; i < boom.sections().size(); ++i)
    if (boom.sections()[i].name() == name) return i;
  throw std::runtime_error(name);
}

Errors errorsOf(const std::string& parameters, const Sensors& sensors) {
  const Settings settings = test::settingsWith(parameters);
  Pipeline pipeline(settings.mechanism, settings.pipeline, settings.boom);
  const std::size_t section = sectionNamed(*settings.boom, "boom_middle");
  Errors e;
  play(pipeline, sensors, [&](const OnBoomTruth& t, const SampleResult& result) {
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const double time = seconds(result.ends[k].stamp - 1000000000);
      for (const simulation::BlowTruth& blow : recording().blows) {
        if (std::abs(blow.time - time) > 0.01) continue;
        e.energy += result.ends[k].blow.energy / blow.strike.energy - 1.0;
        ++e.blows;
      }
    }
    if (result.refusal || result.boom == nullptr || result.boom->fault) {
      ++e.refused;
      return;
    }
    ++e.samples;
    e.force_z.add(result.wrench.force_z, t.load.force_z);
    e.moment.add(result.wrench.torque_y, t.load.torque_y + t.drive_reaction_y);
    const BoomState& boom = *result.boom;
    for (int j = 0; j < 3; ++j) {
      e.torque[j].add(boom.loads.total[j + 1] - boom.loads.weight[j + 1], -t.hold[j] - boom.loads.weight[j + 1]);
      e.within += std::abs(boom.loads.total[j + 1] + t.hold[j]) <= 2.0 * boom.deviations.torque[j + 1];
    }
    e.section.add(boom.steel.section[section].torque.y(), t.cut[1].torque_y);
  });
  e.energy /= static_cast<double>(std::max<std::size_t>(1, e.blows));
  return e;
}

void print(const char* name, const Errors& e) {
  std::printf(
      "%s: Fz %.2f|%.2f  My %.2f|%.2f  boom %.2f|%.2f arm %.2f|%.2f hammer %.2f|%.2f  section %.2f %%  "
      "energy %.2f %%  covered %.0f %%\n",
      name, 100 * e.force_z.rmsOfLargest(), 100 * e.force_z.worstOfLargest(), 100 * e.moment.rms(),
      100 * e.moment.worstOfLargest(), 100 * e.torque[0].rms(), 100 * e.torque[0].worstOfLargest(),
      100 * e.torque[1].rms(), 100 * e.torque[1].worstOfLargest(), 100 * e.torque[2].rms(),
      100 * e.torque[2].worstOfLargest(), 100 * e.section.rmsOfLargest(), 100 * e.energy, 100 * e.covered());
}

double worstTorque(const Errors& e) { return std::max({e.torque[0].rms(), e.torque[1].rms(), e.torque[2].rms()}); }

constexpr char kCompliant[] = "boom: compliant\nhull_motion: model\n";

TEST(HammerOnBoomSession, JointsHullAndSectionWithTheRightOil) {
  const Errors e = errorsOf(kCompliant, {});
  print("right oil", e);
  ASSERT_GT(e.samples, 4900U);
  EXPECT_LT(worstTorque(e), 0.02);
  for (const Error& torque : e.torque) EXPECT_LT(torque.worstOfLargest(), 0.06);
  EXPECT_LT(e.moment.rms(), 0.02);
  EXPECT_LT(e.force_z.rmsOfLargest(), 0.01);
  EXPECT_LT(e.section.rmsOfLargest(), 0.04);
  EXPECT_GT(e.section.correlation(), 0.99);
  ASSERT_GT(e.blows, 20U);
  EXPECT_LT(std::abs(e.energy), 0.02) << "by the tool's speed against the rock";
}

TEST(HammerOnBoomSession, AFixedHullLacksWhatItsMotionAdds) {
  const Errors e = errorsOf("boom: compliant\n", {});
  print("fixed hull", e);
  EXPECT_GT(e.force_z.worstOfLargest(), 0.1);
  EXPECT_LT(worstTorque(e), 0.03);
}

TEST(HammerOnBoomSession, AnImuGivesTheHullsMotionAcrossTheBlow) {
  const Errors e = errorsOf("boom: compliant\nhull_motion: imu\n", {true, false, 0.0, 0.0, 0.1});
  print("imu", e);
  EXPECT_LT(e.force_z.rmsOfLargest(), 0.006);
  EXPECT_LT(e.force_z.worstOfLargest(), 0.04);
}

TEST(HammerOnBoomSession, OilThatIsMeasuredSurvivesAWrongBulkModulus) {
  for (const char* modulus : {"0.7e9", "1.4e9"}) {
    const std::string given = std::string(kCompliant) + "bulk_modulus_Pa: " + modulus + "\n";
    const Errors wrong = errorsOf(given, {});
    print(modulus, wrong);
    EXPECT_GT(worstTorque(wrong), 0.3);
    const Errors imu = errorsOf(given + "boom_stiffness: identified\n", {true, false, 0.0, 0.0, 0.3});
    print("  by the imu", imu);
    EXPECT_LT(worstTorque(imu), 0.05);
    EXPECT_GT(imu.covered(), 0.85);
    const Errors pressures = errorsOf(given + "boom_stiffness: identified\n", {false, true, 0.0, 0.0, 0.0, 2e4});
    print("  by pressures", pressures);
    EXPECT_LT(worstTorque(pressures), 0.05);
    EXPECT_LT(pressures.force_z.rmsOfLargest(), 0.01);
  }
}

TEST(HammerOnBoomSession, DeviationsCoverABulkModulusDrawnAtRandom) {
  std::mt19937 random(91);
  double covered = 0.0;
  constexpr int kDraws = 20;
  for (int i = 0; i < kDraws; ++i) {
    const double modulus = 1e9 * std::exp(0.3 * std::normal_distribution<>()(random));
    covered += errorsOf(std::string(kCompliant) + format("bulk_modulus_Pa: %.9g\n", modulus), {}).covered() / kDraws;
  }
  std::printf("covered: %.1f %%\n", 100.0 * covered);
  EXPECT_GT(covered, 0.85);
  EXPECT_LT(covered, 0.995);
}

TEST(HammerOnBoomSession, PressuresReplaceTheCylindersForces) {
  const Settings settings = test::settingsWith("boom: compliant\n");
  Pipeline pipeline(settings.mechanism, settings.pipeline, settings.boom);
  play(pipeline, {false, true, 0.0, 0.0, 0.0, 0.0, true}, [&](const OnBoomTruth& t, const SampleResult& result) {
    ASSERT_NE(result.boom, nullptr);
    ASSERT_TRUE(result.boom->measured);
    for (int j = 0; j < 3; ++j) ASSERT_NEAR(result.boom->loads.total[j + 1], -t.hold[j], 2e-3 * 3e4) << t.time;
    ASSERT_TRUE(result.boom->hold_down_force_lost) << "it hangs free";
  });
}

/// A passage at the very begin of a step once gave its momentum as a force.
TEST(HammerOnBoomSession, NoMeanIsAKickWithTheEncoderOff) {
  double peak = 0.0;
  for (const OnBoomTruth& t : recording().truth) peak = std::max(peak, t.load.force_z);
  for (const double zero : {-0.01, -0.001, 0.0, 0.001, 0.01}) {
    const Settings settings = test::settingsWith("output: mean\nboom: compliant\n");
    Pipeline pipeline(settings.mechanism, settings.pipeline, settings.boom);
    double largest = 0.0, vibration = 0.0, true_torque = 0.0;
    play(pipeline, {false, false, zero}, [&](const OnBoomTruth& t, const SampleResult& result) {
      if (result.refusal) return;
      for (const WrenchOutput& output : result.outputs)
        largest = std::max(largest, std::hypot(output.wrench.force_x, output.wrench.force_z));
      vibration = std::max(vibration, result.boom->loads.total.cwiseAbs().maxCoeff());
      true_torque = std::max(true_torque, t.hold.cwiseAbs().maxCoeff());
    });
    EXPECT_LT(largest, 1.6 * peak) << zero;
    EXPECT_LT(vibration, 1.3 * true_torque) << zero;
  }
}

}  // namespace
}  // namespace hammer_loads
