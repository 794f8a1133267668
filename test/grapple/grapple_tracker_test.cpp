#include "hammer_loads/grapple/grapple_tracker.h"

#include <gtest/gtest.h>

#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

GrappleTracker trackerOf(const GrappleParameters& p) { return GrappleTracker(test::grappleOf(p)); }

TEST(GrappleTracker, ABadFirstSampleLeavesItEmpty) {
  GrappleTracker tracker = trackerOf(test::claimsParameters());
  EXPECT_EQ(tracker.update({0.74, 0.0, 0.0}), SliderRefusal::kAcrossFold);
  EXPECT_FALSE(tracker.hasMotion());
  EXPECT_EQ(tracker.update({0.1, 0.0, 0.0}), SliderRefusal::kNone);
  EXPECT_TRUE(tracker.hasMotion());
}

TEST(GrappleTracker, ResetStartsColdAndKeepsTheCounts) {
  GrappleTracker tracker = trackerOf(test::claimsParameters());
  ASSERT_EQ(tracker.update({0.3, 0.0, 0.0}), SliderRefusal::kNone);
  ASSERT_EQ(tracker.update({0.5, 0.0, 0.0}), SliderRefusal::kNone);
  ASSERT_EQ(tracker.update({0.74, 0.0, 0.0}), SliderRefusal::kAcrossFold);
  tracker.reset();
  EXPECT_FALSE(tracker.hasMotion());
  ASSERT_EQ(tracker.update({0.1, 0.0, 0.0}), SliderRefusal::kNone);
  const GrappleMotion cold = *tracker.grapple().at(0.1);
  EXPECT_EQ(tracker.motion().p.re, cold.p.re) << "bit for bit, or a bag would not give the same again";
  EXPECT_EQ(tracker.motion().theta5, cold.theta5);
  EXPECT_EQ(tracker.count(SliderRefusal::kNone), 3u);
  EXPECT_EQ(tracker.refused(), 1u);
}

TEST(GrappleTracker, NeverLeavesTheBranchUpToTheFold) {
  GrappleParameters p = test::claimsParameters();
  const Grapple whole = test::grappleOf(p);
  p.slider_open = whole.upperLimit().slider - 1e-9;
  p.slider_margin = 0.0;
  GrappleTracker tracker = trackerOf(p);
  test::Random random(51);
  // Moves onto the fold in ever shorter steps and away from it in one. det J keeps its sign.
  for (int i = 0; i < 2000; ++i) {
    const double distance = i % 2 == 0 ? std::pow(10.0, random(-9.0, -1.0)) : random(0.1, 0.7);
    ASSERT_EQ(tracker.update({whole.upperLimit().slider - distance, 0.0, 0.0}), SliderRefusal::kNone) << distance;
    EXPECT_LT(tracker.motion().determinant, 0.0);
    const GrappleMotion cold = *whole.at(tracker.slider().position);
    // Near the fold, rounding moves the pose by eps/sqrt(distance).
    EXPECT_NEAR(tracker.motion().theta2, cold.theta2, 1e-14 / std::sqrt(distance));
  }
  EXPECT_EQ(tracker.refused(), 0u);
}

}  // namespace
}  // namespace hammer_loads
