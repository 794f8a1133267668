#include "hammer_loads/grapple/folds.h"

#include <gtest/gtest.h>

#include "grapple/explicit_curve.h"
#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

FirstRocker rockerOf(const GrappleParameters& p) { return {p.o1, p.o1a}; }

/// Returns the volume of the three normalised line coordinates of AO, BD and CE, relative to lengths of one metre. det
/// J = 0 exactly where these lines meet in one point or are parallel.
double concurrency(const FirstRocker& rocker, const GroupPose& pose, double theta1) {
  const Planar a = rocker.o1 + rocker.armAt(theta1);
  struct Line {
    Planar normal;
    double offset;
  };
  const auto through = [](Planar point, Planar along) {
    const Planar normal = (1.0 / norm(along)) * turned(along);
    return Line{normal, dot(normal, point)};
  };
  const Line l1 = through({0.0, 0.0}, a), l2 = through(pose.d, pose.u), l3 = through(pose.e, pose.v);
  return l1.offset * cross(l2.normal, l3.normal) + l2.offset * cross(l3.normal, l1.normal) +
         l3.offset * cross(l1.normal, l2.normal);
}

TEST(Folds, AreSingularAndEndTheBranchOfRandomLinkages) {
  test::Random random(31);
  int folds = 0, full_turns = 0, singular = 0;
  for (int i = 0; i < 2000; ++i) {
    const GrappleParameters p = test::randomLinkage(random);
    const LeverGroup group(p);
    const FirstRocker rocker = rockerOf(p);
    const double theta1 = random(-kPi, kPi);
    const Branches all = enumerateBranches(group, rocker.o1 + rocker.armAt(theta1));
    if (all.count == 0) continue;
    const auto& branch = all.branch[static_cast<std::size_t>(random(0.0, all.count))];
    const int sense = random.coin() ? 1 : -1;
    const BranchEnd end = findBranchEnd(group, rocker, {theta1, branch.theta2, branch.theta5}, sense, 2.0 * kPi);
    singular += end.kind == BranchEnd::Kind::kSingular;
    if (end.kind == BranchEnd::Kind::kNone) {
      ++full_turns;
      EXPECT_GE(sense * (end.point.theta1 - theta1), 2.0 * kPi);
    }
    if (end.kind != BranchEnd::Kind::kFold) continue;
    ++folds;
    EXPECT_GT(sense * (end.point.theta1 - theta1), 0.0);
    const Planar a = rocker.o1 + rocker.armAt(end.point.theta1);
    const GroupPose pose = group.pose(a, end.point.theta2, end.point.theta5);
    EXPECT_NEAR(norm(pose.u), p.bd, 1e-13) << i;
    EXPECT_NEAR(norm(pose.v), p.ce, 1e-13) << i;
    EXPECT_NEAR(concurrency(rocker, pose, end.point.theta1), 0.0, 1e-12) << i;
    // Two modes vanish there.
    const auto countAt = [&](double angle) { return enumerateBranches(group, rocker.o1 + rocker.armAt(angle)).count; };
    const double step = 1e-6;
    EXPECT_EQ(countAt(end.point.theta1 - sense * step) - countAt(end.point.theta1 + sense * step), 2) << i;
  }
  EXPECT_GT(folds, 500);
  EXPECT_GT(full_turns, 10);
  EXPECT_EQ(singular, 0);
}

TEST(SliderLimits, AreThoseOfBothSets) {
  const Grapple claims = test::grappleOf(test::claimsParameters());
  EXPECT_EQ(claims.lowerLimit().kind, SliderLimit::Kind::kDeadCentre);
  EXPECT_NEAR(claims.lowerLimit().slider, -0.27, 1e-15);
  EXPECT_EQ(claims.upperLimit().kind, SliderLimit::Kind::kFold);
  EXPECT_NEAR(claims.upperLimit().slider, 0.7331923934966, 1e-13);
  const Grapple straight = test::grappleOf(test::straightParameters());
  EXPECT_EQ(straight.lowerLimit().kind, SliderLimit::Kind::kFold);
  EXPECT_EQ(straight.upperLimit().kind, SliderLimit::Kind::kFold);
  EXPECT_NEAR(straight.upperLimit().slider, -0.019779803958286, 1e-14);
}

TEST(SliderLimits, FoldsEqualTheExplicitCurveToFiftyDigits) {
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    const Grapple grapple = test::grappleOf(p);
    for (const SliderLimit& limit : {grapple.lowerLimit(), grapple.upperLimit()}) {
      if (limit.kind != SliderLimit::Kind::kFold) continue;
      const double inwards = limit.slider < 0.5 * (p.slider_closed + p.slider_open) ? 1e-4 : -1e-4;
      const auto fold = test::exactFoldNear(p, *grapple.at(limit.slider + inwards));
      ASSERT_TRUE(fold);
      EXPECT_NEAR(limit.slider, static_cast<double>(fold->slider.v), 1e-15);
    }
  }
}

TEST(SliderLimits, FoldsOfRandomGrapplesEqualTheExplicitCurve) {
  test::Random random(32);
  int checked = 0, tried = 0;
  for (int i = 0; i < 750; ++i) {
    const auto grapple = test::randomGrapple(random);
    if (!grapple) continue;
    const double width = grapple->upperLimit().slider - grapple->lowerLimit().slider;
    for (const auto& [limit, inwards] :
         {std::pair{grapple->lowerLimit(), 1e-5 * width}, std::pair{grapple->upperLimit(), -1e-5 * width}}) {
      if (limit.kind != SliderLimit::Kind::kFold) continue;
      const auto beside = grapple->at(limit.slider + inwards);
      ASSERT_TRUE(beside) << i;
      ++tried;
      const auto fold = test::exactFoldNear(grapple->parameters(), *beside);
      if (!fold) continue;  // the oracle's Newton iteration left its neighbourhood
      const double exact = static_cast<double>(fold->slider.v);
      if (std::abs(exact - limit.slider) > 1e-3 * width) continue;  // it found the next fold
      EXPECT_NEAR(limit.slider, exact, 1e-12) << i;
      ++checked;
    }
  }
  EXPECT_GT(checked, 25);
  EXPECT_GT(checked, 0.9 * tried);
}

}  // namespace
}  // namespace hammer_loads
