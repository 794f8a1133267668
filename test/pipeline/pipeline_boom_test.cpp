/// Tests the pipeline with the shipped boom over a working session: memory allocation, joint loads, and the behaviour
/// when joint states or crank samples fail.
#include <gtest/gtest.h>

#include "support/constants.h"
#include "support/counting_new.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kSessionEnd;
using test::kSessionWorks;
using test::Player;
using test::session;
using test::settingsWith;

using test::kGravity;
constexpr double kJointsHeard = 0.02;  // [s]: the first joint states arrive within one period of theirs

const auto kOnlyPlay = [](double, const SampleResult&) {};

/// Reads everything that a node publishes per sample, except the messages.
struct Everything {
  Pipeline& pipeline;
  double& sum;
  void operator()(double, const SampleResult& loads) const {
    for (const WrenchOutput& output : loads.outputs) {
      sum += output.deviation.wrench().force_z;
      if (!pipeline.boom() || !pipeline.boom()->known()) continue;
      for (int link = 1; link < 5; ++link) sum += pipeline.boom()->wrenchAtLink(link, output.wrench).torque.y();
    }
    if (loads.boom != nullptr && !loads.boom->fault) sum += loads.boom->loads.total.sum();
  }
};

TEST(PipelineWithBoom, AllocatesNothingPerSample) {
  const std::size_t before_control = test::allocations;
  void* volatile block = std::malloc(1);  // volatile: otherwise the compiler may omit both calls
  std::free(block);
  ASSERT_GT(test::allocations, before_control) << "the counter must see an allocation";
  for (const char* motion : {"fixed", "imu", "model"}) {
    const Settings settings =
        settingsWith(std::string("drive_reaction_ratio: 0.0\nboom: compliant\nhull_motion: ") + motion + "\n");
    Player player(settings);
    player.imu = test::atRest(0.0, settings.pipeline.imu);
    double sum = 0.0;
    const std::size_t before = test::allocations;
    player.playTo(kSessionEnd, Everything{player.pipeline, sum});
    EXPECT_EQ(test::allocations, before) << motion;
    EXPECT_EQ(player.pipeline.counts().accepted, session().crank.size()) << motion;
    EXPECT_TRUE(player.pipeline.boom()->state().choice.judged) << motion;
    EXPECT_TRUE(std::isfinite(sum)) << motion;
  }
}

/// The description's hull mass includes the moving links, whose weight must not load the joints twice.
TEST(PipelineWithBoom, JointsCarryTheLinksMotionAndTheirWeightOnce) {
  const Settings settings = settingsWith("boom: rigid\n");
  Player player(settings);
  double peak = 0.0;
  player.playTo(kJointsHeard, kOnlyPlay);
  player.playTo(kSessionEnd, [&](double time, const SampleResult& loads) {
    ASSERT_TRUE(loads.boom != nullptr && !loads.boom->fault) << time;
    const CrankMotion crank{loads.crank.position.angle, loads.crank.speed, loads.crank.acceleration};
    HullWrench w = hullWrench(HullModel(settings.mechanism, settings.pipeline.level), crank, Gravity{});
    w.torque_y -= player.pipeline.crank().tracker().driveInertia() * crank.acceleration;
    const BoomLoads& told = loads.boom->loads;
    // Hand calculation about hammer_joint. D is (0.10, -0.55) m from it in the hull's axes; bracket 50 kg, hull 350 kg.
    const double hammer = w.torque_y - 0.55 * w.force_x - 0.10 * w.force_z;
    const double pitch = player.pipeline.hull().pitch().pitch();
    const double lever_x = 50.0 * 0.03 + 350.0 * (0.10 - 0.08), lever_z = -50.0 * 0.06 - 350.0 * (0.55 - 0.05);
    const double weight = kGravity * (lever_x * std::cos(pitch) + lever_z * std::sin(pitch));
    ASSERT_NEAR(told.hammer[3], hammer, 1e-12 * 1e4) << time;
    ASSERT_NEAR(told.weight[3], weight, 1e-12 * 1e4) << time;
    ASSERT_NEAR(told.total[3], told.hammer[3] + told.weight[3] + told.motion[3], 1e-12 * 1e4) << time;
    ASSERT_NEAR(told.hammer[0], 0.0, 1e-12 * 1e4) << "a plane load does not swing the machine";
    peak = std::max(peak, told.hammer.cwiseAbs().maxCoeff());
  });
  EXPECT_GT(peak, 5e3);
}

TEST(PipelineWithBoom, StaleJointsSilenceTheBoomAloneUntilTheyAreBack) {
  const Settings settings = settingsWith("boom: compliant\n");
  constexpr double kSilent = 3.0, kBack = 4.0, kMaxAge = 0.2, kPeriod = 0.02;
  Player player(settings);
  int known = 0, faults = 0;
  const auto watch = [&](double time, const SampleResult& loads) {
    ASSERT_FALSE(loads.refusal) << time;
    ASSERT_NE(loads.boom, nullptr) << time;
    const bool stale = time > kSilent + kMaxAge && time < kBack;
    if (!stale && time > kSilent + kMaxAge - kPeriod && time < kBack + kPeriod) return;  // either is correct
    ASSERT_EQ(loads.boom->fault.has_value(), stale) << time;
    ASSERT_EQ(player.pipeline.boom()->known(), !stale) << time;
    ASSERT_TRUE(!stale || loads.boom->fault->kind == JointFault::Kind::kStale) << time;
    ++(stale ? faults : known);
  };
  player.playTo(kJointsHeard, kOnlyPlay);
  player.playTo(kSilent, watch);
  EXPECT_GT(player.pipeline.boom()->state().tip.velocity.norm(), 0.0);
  player.joints_speak = false;
  player.playTo(kBack, watch);
  EXPECT_EQ(player.pipeline.boom()->joints().complaints(player.pipeline.boom()->state().stamp).size(), 4U);
  player.joints_speak = true;
  bool first = true;
  player.playTo(kSessionEnd, [&](double time, const SampleResult& loads) {
    watch(time, loads);
    if (loads.boom->fault) return;
    EXPECT_TRUE(!first || loads.boom->tip.displacement.isZero(0.0)) << "nothing is known of it: from rest";
    first = false;
  });
  EXPECT_GT(known, 3700);
  EXPECT_GT(faults, 750);
  EXPECT_EQ(player.pipeline.boom()->joints().complaints(player.pipeline.boom()->state().stamp).size(), 0U);
  EXPECT_EQ(player.pipeline.counts().accepted, session().crank.size());
}

/// The gap is longer than stale_after_s: the motion of the crank during it is unknown.
TEST(PipelineWithBoom, VibrationRestartsAfterADropOut) {
  const Settings settings = settingsWith("boom: compliant\n");
  constexpr double kFrom = 3.5, kTo = 3.9, kShortFrom = 3.0, kShortTo = 3.005;
  const simulation::Session session = test::record({{kShortFrom, kShortTo}, {kFrom, kTo}});
  Player player(settings, true, session);
  player.playTo(kFrom, [&](double time, const SampleResult& loads) {
    if (time < kSessionWorks + 0.5) return;
    ASSERT_NE(loads.boom, nullptr) << time;
    ASSERT_GT(loads.boom->tip.displacement.norm(), 0.0) << "a gap of a few samples ends nothing: " << time;
  });
  const std::uint64_t restarts = player.pipeline.counts().restarts;
  std::optional<double> first;
  double largest = 0.0;
  player.playTo(kSessionEnd, [&](double time, const SampleResult& loads) {
    if (loads.boom == nullptr) return;
    if (!first) {
      first = time;
      EXPECT_TRUE(loads.boom->tip.displacement.isZero(0.0) && loads.boom->tip.velocity.isZero(0.0)) << time;
      EXPECT_TRUE(loads.boom->loads.vibration.isZero(0.0)) << time;
    }
    ASSERT_TRUE(loads.boom->loads.total.allFinite()) << time;
    largest = std::max(largest, loads.boom->tip.displacement.norm());
  });
  EXPECT_EQ(player.pipeline.counts().restarts, restarts + 1);
  ASSERT_TRUE(first);
  EXPECT_LT(*first, kTo + 0.1);
  EXPECT_GT(largest, 1e-3);
}

}  // namespace
}  // namespace hammer_loads
