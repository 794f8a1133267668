#include "hammer_loads/pipeline/crank_sample_gate.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "hammer_loads/linkage/crank_angle.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;

class IntakeTest : public testing::Test {
 protected:
  CrankSampleGate::Verdict judge(StampNs stamp, std::optional<double> given = {}, double speed = 10.0) {
    const double angle = given.value_or(1e-9 * static_cast<double>(stamp));
    const CrankSampleGate::Verdict verdict = intake_.judge(stamp, {angle, speed});
    if (!verdict.refusal) intake_.accept(stamp, {angle, speed});
    return verdict;
  }
  CrankSampleGate intake_{{300.0, 0.25, 0.01, 1.5}};
};

TEST_F(IntakeTest, GivesTheStepBetweenAcceptedSamples) {
  EXPECT_EQ(judge(5 * kMs).order, CrankSampleGate::Order::kFirst);
  const CrankSampleGate::Verdict next = judge(7 * kMs);
  EXPECT_EQ(next.order, CrankSampleGate::Order::kNext);
  EXPECT_DOUBLE_EQ(next.step, 2e-3);
}

TEST_F(IntakeTest, RefusesEachBadSampleAndTakesTheNextGoodOne) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  judge(5 * kMs);
  EXPECT_EQ(judge(6 * kMs, kNan).refusal, Refusal::kNotFinite);
  EXPECT_EQ(judge(6 * kMs, 1.0, -kInf).refusal, Refusal::kNotFinite);
  EXPECT_EQ(judge(6 * kMs, 1e308).refusal, Refusal::kImplausible);
  EXPECT_EQ(judge(6 * kMs, 1.0, 301.0).refusal, Refusal::kImplausible);
  EXPECT_EQ(judge(5 * kMs).refusal, Refusal::kDuplicate);
  EXPECT_EQ(judge(4 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_FALSE(judge(6 * kMs).refusal);
}

TEST_F(IntakeTest, RestartsAfterAGapLongerThanStale) {
  judge(0);
  EXPECT_EQ(judge(249 * kMs).order, CrankSampleGate::Order::kNext);
  EXPECT_EQ(judge(500 * kMs).order, CrankSampleGate::Order::kFirst);
}

TEST_F(IntakeTest, AcceptsTimeRunningBackFromTheSecondSampleOn) {
  judge(1000 * kMs);
  EXPECT_EQ(judge(10 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_EQ(judge(11 * kMs).order, CrankSampleGate::Order::kFirst);
  EXPECT_EQ(judge(12 * kMs).order, CrankSampleGate::Order::kNext);
}

TEST_F(IntakeTest, OneLateSampleChangesNothing) {
  judge(1000 * kMs);
  EXPECT_EQ(judge(990 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_FALSE(judge(1001 * kMs).refusal);
  EXPECT_EQ(judge(991 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_FALSE(judge(1002 * kMs).refusal);
}

TEST_F(IntakeTest, AnAngleThatStandsStillWhileTheSpeedGoesOnIsRefusedUntilItMoves) {
  judge(0, 1.0, 20.0);
  for (int i = 1; i <= 400; ++i) EXPECT_EQ(judge(i * kMs, 1.0, 20.0).refusal, Refusal::kImplausible) << i;
  const CrankSampleGate::Verdict moving = judge(401 * kMs, 1.02, 20.0);
  EXPECT_FALSE(moving.refusal);
  EXPECT_EQ(moving.order, CrankSampleGate::Order::kFirst) << "stale by then";
  EXPECT_EQ(judge(402 * kMs, 1.02, 20.0).refusal, Refusal::kImplausible);
  EXPECT_FALSE(judge(403 * kMs, 1.02, 0.1).refusal) << "now the speed agrees that it stands";
}

TEST_F(IntakeTest, TheSameAngleIsNoFaultOfACrankThatStandsOrCreepsOrTurnedRound) {
  judge(0, 1.0, 0.0);
  for (int i = 1; i <= 100; ++i) EXPECT_FALSE(judge(i * kMs, 1.0, i % 2 == 0 ? 1.4 : -1.4).refusal) << "noise";
  for (int i = 101; i <= 104; ++i) EXPECT_FALSE(judge(i * kMs, 1.0, 9.0).refusal) << "0.009 rad: within a few counts";
  EXPECT_FALSE(judge(304 * kMs, 1.0, 31.4).refusal) << "one whole turn later";
}

TEST_F(IntakeTest, ASpeedOfNothingButZerosIsNoneWhileTheAngleMoves) {
  EXPECT_FALSE(judge(0, 1.00, 0.0).speed_is_dead) << "one zero may be true";
  EXPECT_TRUE(judge(1 * kMs, 1.02, 0.0).speed_is_dead);
  EXPECT_FALSE(judge(2 * kMs, 1.021, 0.0).speed_is_dead) << "it creeps";
  EXPECT_FALSE(judge(3 * kMs, 1.05, 0.001).speed_is_dead);
  EXPECT_FALSE(judge(4 * kMs, 1.07, 0.0).speed_is_dead);
  EXPECT_TRUE(judge(5 * kMs, kTwoPi + 1.09, 0.0).speed_is_dead) << "whatever the winding";
}

}  // namespace
}  // namespace hammer_loads
