// Strokes by which a crank sensor is accepted or rejected.
#include <gtest/gtest.h>

#include "hammer_loads/pipeline/crank_trust.h"

namespace hammer_loads {
namespace {

constexpr double kPoseStep = 1e-3;  // [s]

TEST(CrankTrustStrokes, LosesTheCrankAfterTwoRefusedStrokesInARow) {
  CrankTrust trust{CrankSensor{}};
  double angle = 0.0;
  const auto stroke = [&](bool believed) {
    for (int i = 0; i < 20; ++i) trust.follow(angle += 0.1, 1.0, kPoseStep);
    trust.passBlow(believed);
    return trust.isInconsistent();
  };
  EXPECT_FALSE(stroke(false));
  EXPECT_FALSE(stroke(true));
  EXPECT_FALSE(stroke(false));
  EXPECT_TRUE(stroke(false));
  EXPECT_TRUE(trust.isLost());
  EXPECT_TRUE(stroke(false));
  EXPECT_FALSE(stroke(true)) << "one ends it";
  stroke(false);
  trust.begin();
  EXPECT_FALSE(stroke(false)) << "what was lost in a gap is no contradiction";
}

TEST(CrankTrustStrokes, LearnsNothingFromACrankThatRocksAtTheDeadCentre) {
  CrankTrust trust{CrankSensor{}};
  for (int i = 0; i < 10; ++i) {
    trust.follow(i % 2 == 0 ? 0.4 : -0.4, 1.0, kPoseStep);
    trust.passBlow(false);
  }
  EXPECT_FALSE(trust.isInconsistent());
}

}  // namespace
}  // namespace hammer_loads
