// A rod that gives is known by where in the turn innovations are too large.
#include <gtest/gtest.h>


#include "hammer_loads/crank/consistency.h"

namespace hammer_loads {
namespace {

constexpr double kFine = 4e-4, kCoarse = 1.3e-3;  // [rad] of a reading

/// A turn's samples: three of them each 10 deg.
RodEvidence after(double picked_up, double later, int turns) {
  RodEvidence rod;
  for (int i = 0; i < turns; ++i) {
    for (int degree = 1; degree < 180; degree += 3) {
      const double ratio = degree < 30 ? picked_up : degree < 90 ? 0.5 * (picked_up + later) : later;
      rod.add({degree * kDegree, Side::kAfterBlow}, ratio);
      rod.add({-degree * kDegree, Side::kBeforeBlow}, 50.0);  // the strike says nothing of it
    }
  }
  return rod;
}

TEST(RodEvidence, IsTheExcessJustAfterTheBlow) {
  EXPECT_TRUE(after(2.6, 1.0, 50).gives());   // a rod behind 1024 counts
  EXPECT_FALSE(after(1.7, 1.0, 50).gives());  // a zero that is off
  EXPECT_TRUE(after(9.0, 1.9, 50).gives());   // worn pins rattle later as well
  EXPECT_FALSE(after(9.0, 3.2, 50).gives());  // a coupling disturbs the whole turn
  EXPECT_FALSE(after(16.0, 1.0, 3).gives());  // 30 samples
  EXPECT_TRUE(after(16.0, 1.0, 6).gives());   // 60
  EXPECT_NEAR(after(1e9, 1.0, 50).pickedUp(), 100.0, 1.0);
}

/// What contradicts a rigid mechanism before the blow and after it are two questions.
TEST(RodEvidence, KnowsARockerThatIsLetGoByTheRunUp) {
  RodEvidence worn;
  EXPECT_EQ(worn.releasedShare(kFine), 1.0);  // too few
  for (int turn = 0; turn < 50; ++turn)
    for (int degree = -60; degree < 0; degree += 3)
      worn.add({degree * kDegree, Side::kBeforeBlow}, degree > -30 ? 4.3 : 0.9);
  EXPECT_NEAR(worn.runUp(), 4.3, 1e-9);
  EXPECT_EQ(worn.releasedShare(kFine), 1.0);
  RodEvidence tight;
  for (int i = 0; i < 400; ++i) {
    tight.add({-10.0 * kDegree, Side::kBeforeBlow}, 0.95);
    tight.add({10.0 * kDegree, Side::kAfterBlow}, 4.3);
  }
  EXPECT_LT(tight.releasedShare(kFine), 0.06);
  EXPECT_EQ(tight.share(kFine), 1.0);
}

TEST(RodEvidence, ARigidMechanismIsLostWhereItIsContradictedAQuarterTurnLater) {
  EXPECT_TRUE(after(38.0, 8.0, 50).isLost());
  EXPECT_FALSE(after(47.0, 1.9, 50).isLost());  // worn pins
  EXPECT_FALSE(after(38.0, 8.0, 1).isLost());   // 30 samples
}

TEST(RodEvidence, ForgetsARodThatWasReplaced) {
  RodEvidence rod = after(16.0, 1.0, 50);
  for (int i = 0; i < 200; ++i)
    for (int degree = 1; degree < 30; degree += 3) rod.add({degree * kDegree, Side::kAfterBlow}, 0.9);
  EXPECT_FALSE(rod.gives());
}

}  // namespace
}  // namespace hammer_loads
