#include "hammer_loads/pipeline/intake.h"

#include <limits>

#include "support/main.h"

namespace hammer_loads {
namespace {

constexpr StampNs kMs = 1000000;

class IntakeTest : public testing::Test {
 protected:
  Intake::Verdict judge(StampNs stamp, double angle = 1.0, double speed = 10.0) {
    const Intake::Verdict verdict = intake_.judge(stamp, {angle, speed});
    if (!verdict.refusal) intake_.accept(stamp);
    return verdict;
  }
  Intake intake_{300.0, 0.25};
};

TEST_F(IntakeTest, GivesTheStepBetweenAcceptedSamples) {
  EXPECT_EQ(judge(5 * kMs).order, Intake::Order::kFirst);
  const Intake::Verdict next = judge(7 * kMs);
  EXPECT_EQ(next.order, Intake::Order::kNext);
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

TEST_F(IntakeTest, AGapLongerThanStaleBeginsAnew) {
  judge(0);
  EXPECT_EQ(judge(249 * kMs).order, Intake::Order::kNext);
  EXPECT_EQ(judge(500 * kMs).order, Intake::Order::kFirst);
}

TEST_F(IntakeTest, TimeRunningBackIsBelievedFromTheSecondSampleOn) {
  judge(1000 * kMs);
  EXPECT_EQ(judge(10 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_EQ(judge(11 * kMs).order, Intake::Order::kFirst);
  EXPECT_EQ(judge(12 * kMs).order, Intake::Order::kNext);
}

TEST_F(IntakeTest, OneLateSampleChangesNothing) {
  judge(1000 * kMs);
  EXPECT_EQ(judge(990 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_FALSE(judge(1001 * kMs).refusal);
  EXPECT_EQ(judge(991 * kMs).refusal, Refusal::kOutOfOrder);
  EXPECT_FALSE(judge(1002 * kMs).refusal);
}

}  // namespace
}  // namespace hammer_loads

HAMMER_LOADS_TEST_MAIN
