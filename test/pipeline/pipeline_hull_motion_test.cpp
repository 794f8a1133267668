/// Tests the hull's own motion in the wrench of a session: none, from its IMU, from the compliant boom.
#include <gtest/gtest.h>

#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kSessionEnd;
using test::Player;
using test::session;
using test::settingsWith;

const auto kJustPlay = [](double, const SampleResult&) {};

void expectSame(const std::vector<HullWrench>& a, const std::vector<HullWrench>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].force_x, b[i].force_x) << i;
    ASSERT_EQ(a[i].force_z, b[i].force_z) << i;
    ASSERT_EQ(a[i].torque_y, b[i].torque_y) << i;
  }
}

/// Returns the wrenches of accepted samples.
std::vector<HullWrench> wrenchesOf(Player& player) {
  std::vector<HullWrench> wrenches;
  player.playTo(kSessionEnd, [&](double, const SampleResult& loads) {
    if (!loads.refusal) wrenches.push_back(loads.wrench);
  });
  return wrenches;
}

/// Computing the boom's loads as well does not change the hull wrench.
TEST(PipelineHullMotion, AFixedHullsWrenchDoesNotDependOnTheBoom) {
  const Settings settings = settingsWith("boom: compliant\n");
  Player with(settings), without(settings, false);
  const auto right = wrenchesOf(without), given = wrenchesOf(with);
  EXPECT_GT(with.pipeline.boom()->state().tip.displacement.norm(), 0.0) << "it does vibrate";
  ASSERT_EQ(given.size(), right.size());
  // Gravity from the description and gravity from the pitch differ by rounding only.
  for (std::size_t i = 0; i < given.size(); ++i) ASSERT_NEAR(given[i].force_z, right[i].force_z, 1e-7) << i;
}

double peakOf(const std::vector<HullWrench>& wrenches) {
  double peak = 0.0;
  for (const HullWrench& w : wrenches) peak = std::max(peak, w.force_z);
  return peak;
}

TEST(PipelineHullMotion, ARigidBoomDoesNotMoveTheHull) {
  Player fixed(settingsWith("boom: rigid\n"));
  Settings rigid = settingsWith("boom: auto\n", false);  // without cylinders there is no spring
  rigid.pipeline.hull_motion = HullMotionSource::kModel;
  Player moving(rigid);
  const auto still = wrenchesOf(fixed), moved = wrenchesOf(moving);
  EXPECT_FALSE(moving.pipeline.boom()->state().choice.compliant);
  expectSame(still, moved);
}

constexpr char kImuSettings[] =
    "hull_motion: imu\nimu_x_m: 0.1\nimu_y_m: 0.15\nimu_z_m: 0.25\n"
    "imu_roll_rad: 3.1\nimu_pitch_rad: -0.2\nimu_yaw_rad: 1.5\n";

TEST(PipelineHullMotion, AnImuOnATiltedHullAtRestGivesTheWeightByPitch) {
  for (const double pitch : {-0.6, 0.0, 0.9}) {
    const std::string tilt = format("hull_pitch_rad: %.17g\n", pitch);
    const Settings settings = settingsWith(kImuSettings);
    Player with(settings), by_pitch(settingsWith(tilt));
    by_pitch.joints_speak = with.joints_speak = false;  // otherwise the pitch from the joints is used
    with.imu = test::atRest(pitch, settings.pipeline.imu);
    with.pipeline.hullImu(session().crank.front().stamp - 1000000, *with.imu);  // one reading alone gives no motion yet
    const auto right = wrenchesOf(by_pitch), given = wrenchesOf(with);
    ASSERT_EQ(given.size(), right.size());
    const double peak = peakOf(right);
    for (std::size_t i = 0; i < given.size(); ++i) {
      ASSERT_NEAR(given[i].force_x, right[i].force_x, 1e-9 * peak) << pitch << ' ' << i;
      ASSERT_NEAR(given[i].force_z, right[i].force_z, 1e-9 * peak) << pitch << ' ' << i;
      ASSERT_NEAR(given[i].torque_y, right[i].torque_y, 1e-9 * peak) << pitch << ' ' << i;
    }
    EXPECT_EQ(with.pipeline.hull().imuCounts().missed, 0U);
    EXPECT_EQ(with.pipeline.hull().imuCounts().accepted, session().crank.size() + 1);
  }
}

TEST(PipelineHullMotion, ASilentImuLeavesTheWeightByPitchAndIsCounted) {
  const Settings settings = settingsWith(kImuSettings);
  Player silent(settings), fixed(settingsWith("hull_motion: fixed\n"));
  const auto right = wrenchesOf(fixed), given = wrenchesOf(silent);
  expectSame(given, right);
  EXPECT_EQ(silent.pipeline.hull().imuCounts().missed, session().crank.size());

  Player failing(settings);
  const ImuCounts& counts = failing.pipeline.hull().imuCounts();
  failing.imu = test::atRest(0.0, settings.pipeline.imu);
  failing.playTo(3.0, kJustPlay);
  EXPECT_EQ(counts.missed, 1U);
  failing.imu.reset();
  failing.playTo(3.049, kJustPlay);  // 50 ms: imu_max_age_s
  EXPECT_EQ(counts.missed, 1U);
  failing.playTo(4.0, [](double time, const SampleResult& loads) { ASSERT_FALSE(loads.refusal) << time; });
  EXPECT_NEAR(static_cast<double>(counts.missed), 1.0 + 950.0, 2.0);
  const std::uint64_t missed = counts.missed;
  failing.imu = test::atRest(0.0, settings.pipeline.imu);
  failing.playTo(kSessionEnd, kJustPlay);
  EXPECT_EQ(counts.missed, missed + 1);
}

}  // namespace
}  // namespace hammer_loads
