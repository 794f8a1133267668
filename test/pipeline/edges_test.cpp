/// Input that must not change a value: refused samples, stamps beyond every clock, sensors in degrees.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/pipeline/warnings.h"
#include "support/constants.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::session;
using test::settingsWith;

const std::vector<std::string> kJoints{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};

Pipeline pipelineOf(const Settings& settings) { return Pipeline(settings.mechanism, settings.pipeline, settings.boom); }

/// Plays the session and returns its wrenches; each(pipeline, reading, wrenches) adds those of one crank reading.
template <typename Each>
std::vector<HullWrench> wrenchesOf(const Settings& settings, const Each& each, double boom_unit = 1.0) {
  Pipeline pipeline(settings.mechanism, settings.pipeline, settings.boom);
  std::vector<HullWrench> wrenches;
  std::size_t joint = 0;
  for (const simulation::CrankReading& reading : session().crank) {
    for (; joint < session().joints.size() && session().joints[joint].stamp <= reading.stamp; ++joint) {
      std::vector<double> angles(session().joints[joint].position.begin(), session().joints[joint].position.end());
      for (double& angle : angles) angle *= boom_unit;
      pipeline.boomJoints(session().joints[joint].stamp, kJoints, angles, {});
    }
    each(pipeline, reading, wrenches);
  }
  return wrenches;
}

void keep(const SampleResult& result, std::vector<HullWrench>& wrenches) {
  if (!result.refusal) wrenches.push_back(result.wrench);
}

class RefusedSamples : public testing::TestWithParam<const char*> {};

TEST_P(RefusedSamples, ChangeNothingElse) {
  const Settings settings = settingsWith(std::string("boom: compliant\nhull_motion: ") + GetParam() + "\n");
  const auto once = [](Pipeline& pipeline, const auto& r, auto& wrenches) {
    keep(pipeline.crankSample(r.stamp, {r.angle, r.speed}), wrenches);
  };
  const auto with_bad_ones = [](Pipeline& pipeline, const auto& r, auto& wrenches) {
    keep(pipeline.crankSample(r.stamp, {r.angle, r.speed}), wrenches);
    EXPECT_EQ(pipeline.crankSample(r.stamp, {r.angle, r.speed}).refusal, Refusal::kDuplicate);
    EXPECT_EQ(pipeline.crankSample(r.stamp + 1, {std::nan(""), r.speed}).refusal, Refusal::kNotFinite);
    EXPECT_EQ(pipeline.crankSample(kLastStamp + 1, {r.angle, r.speed}).refusal, Refusal::kBadStamp);
    EXPECT_EQ(pipeline.crankJoint(r.stamp + 1, {"wheel"}, {1.0}, {}).refusal, Refusal::kMissingJoint);
  };
  const auto right = wrenchesOf(settings, once), given = wrenchesOf(settings, with_bad_ones);
  ASSERT_GT(right.size(), 4000U);
  ASSERT_EQ(given.size(), right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    ASSERT_EQ(given[i].force_x, right[i].force_x) << i;
    ASSERT_EQ(given[i].force_z, right[i].force_z) << i;
    ASSERT_EQ(given[i].torque_y, right[i].torque_y) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(UnderEveryHullMotion, RefusedSamples, testing::Values("fixed", "imu", "model"));

TEST(BoomInDegrees, IsWithheldUntilItIsOver) {
  const Settings settings = settingsWith("boom: auto\n");
  const auto each = [](Pipeline& pipeline, const auto& r, auto& wrenches) {
    keep(pipeline.crankSample(r.stamp, {r.angle, r.speed}), wrenches);
  };
  EXPECT_GT(wrenchesOf(settings, each).size(), 4000U);
  EXPECT_LT(wrenchesOf(settings, each, test::kDegreesPerRadian).size(), 50U) << "before the first joint states came";

  Pipeline pipeline = pipelineOf(settings);
  StampNs stamp = 1700000000000000000;
  const auto sample = [&] { return pipeline.crankSample(stamp += 1000000, {1.0, 0.0}).refusal; };
  pipeline.boomJoints(stamp, kJoints, {0.2, -20.0, 68.0, -48.0}, {});
  EXPECT_EQ(sample(), Refusal::kDegrees);
  EXPECT_STREQ(warningsOf(pipeline).front().key, "degrees");
  pipeline.boomJoints(stamp + 1, kJoints, {0.2, -0.35, 1.2, -0.85}, {});
  EXPECT_EQ(sample(), std::nullopt);
}

TEST(Missing, CrankJointPitchJointsAndImuAreNamed) {
  const Settings settings = settingsWith("boom: none\nhull_motion: imu\n", false);
  Pipeline pipeline = pipelineOf(settings);
  pipeline.crankJoint(1000, {"wheel"}, {1.0}, {});
  ASSERT_EQ(warningsOf(pipeline).size(), 1U);
  EXPECT_NE(warningsOf(pipeline)[0].text.find("hammer_crank_joint"), std::string::npos);
  pipeline.crankSample(2000000, {1.0, 0.0});
  pipeline.crankSample(3000000, {1.0, 0.0});
  std::string keys;
  for (const Warning& warning : warningsOf(pipeline)) keys += std::string(warning.key) + ";";
  EXPECT_EQ(keys, "pitch joints;imu;");
}

using test::kSessionEnd;
using test::Player;
using test::settingsWith;

/// Covers the whole session, since before work the crank falls back on the tool.
class EncoderZero : public testing::TestWithParam<double> {};

TEST_P(EncoderZero, NoMeanAndNoVibrationIsAKick) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = kSessionEnd;
  machine.crank.zero = GetParam();
  const simulation::Session session = simulation::recordSession(machine);
  double peak = 0.0, stops = 0.0;
  for (const simulation::CrankTruth& t : session.truth) {
    peak = std::max(peak, t.load.force_z);
    if (t.time < 2.0) stops += t.speed == 0.0;
  }
  EXPECT_GT(stops, 100.0) << "it rests on the tool before it works";
  Player right(settingsWith("boom: compliant\n")), off(settingsWith("output: mean\nboom: compliant\n"), true, session);
  double torque = 0.0, off_torque = 0.0, force = 0.0;
  const auto largest = [](const SampleResult& result) { return result.boom->loads.vibration.cwiseAbs().maxCoeff(); };
  right.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    if (!result.refusal && !result.boom->fault) torque = std::max(torque, largest(result));
  });
  off.playTo(kSessionEnd, [&](double, const SampleResult& result) {
    if (result.refusal) return;
    for (const WrenchOutput& output : result.outputs)
      force = std::max(force, std::hypot(output.wrench.force_x, output.wrench.force_z));
    if (!result.boom->fault) off_torque = std::max(off_torque, largest(result));
  });
  EXPECT_LT(force, 1.6 * peak);
  EXPECT_LT(off_torque, 1.5 * torque);
}

INSTANTIATE_TEST_SUITE_P(Off, EncoderZero, testing::Values(-0.01, -0.001, 0.001));

}  // namespace
}  // namespace hammer_loads
