#include "hammer_loads/grapple/branches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

struct Angles {
  double theta2{}, theta5{};
};

double apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

bool contains(const Branches& branches, const Angles& expected, double tolerance) {
  return std::any_of(branches.branch.begin(), branches.branch.begin() + branches.count, [&](const auto& b) {
    return apart(b.theta2, expected.theta2) < tolerance && apart(b.theta5, expected.theta5) < tolerance;
  });
}

Planar pinA(const GrappleParameters& p, double theta1) { return p.o1 + p.o1a * direction(theta1); }

TEST(Branches, FindsAllSixOfTheSixModeCase) {
  GrappleParameters p;
  p.o1 = {1.3, -1.3};
  p.o1a = 0.9;
  p.ab = 1.7;
  p.ac = 1.9;
  p.bac = -1.4;
  p.bd = 2.3;
  p.bp = 1.0;
  p.ce = 2.3;
  p.od = 1.7;
  p.oe = 2.0;
  p.doe = 1.4;
  const Branches found = enumerateBranches(LeverGroup(p), pinA(p, 0.4));
  ASSERT_EQ(found.count, 6);
  EXPECT_FALSE(found.self_motion);
  // To 40 digits by Newton elsewhere.
  for (const Angles& expected : {Angles{-2.945252945483, 0.463930253426},
                                 {-2.581850934118, -2.559905175605},
                                 {-2.054058583304, -0.107159404127},
                                 {-1.412551073309, -1.390482777202},
                                 {1.780980057544, -0.994174154374},
                                 {2.429300890893, -1.988796758067}})
    EXPECT_TRUE(contains(found, expected, 1e-12)) << expected.theta2;
  EXPECT_EQ(std::count_if(found.branch.begin(), found.branch.end(), [](const auto& b) { return b.determinant > 0; }),
            3);
}

TEST(Branches, EveryPoseClosesAndNoPoseIsListedTwice) {
  test::Random random(21);
  int poses = 0;
  for (int i = 0; i < 10000; ++i) {
    const GrappleParameters p = test::randomLinkage(random);
    const LeverGroup group(p);
    const Planar a = pinA(p, random(-kPi, kPi));
    const Branches found = enumerateBranches(group, a);
    EXPECT_FALSE(found.self_motion);
    EXPECT_EQ(found.count % 2, 0) << i;  // modes are born in pairs
    for (int j = 0; j < found.count; ++j) {
      const auto& b = found.branch[static_cast<std::size_t>(j)];
      const GroupPose pose = group.pose(a, b.theta2, b.theta5);
      EXPECT_NEAR(norm(pose.u), p.bd, 2e-14);
      EXPECT_NEAR(norm(pose.v), p.ce, 2e-14);
      for (int k = 0; k < j; ++k) {
        const auto& other = found.branch[static_cast<std::size_t>(k)];
        EXPECT_GT(std::max(apart(b.theta2, other.theta2), apart(b.theta5, other.theta5)), 1e-7);
      }
      ++poses;
    }
  }
  EXPECT_GT(poses, 5000);
}

/// Modes counted without the polynomial: seen from link 5 the jaw's side DB is the crank of a four-bar D-B-C-E; a mode
/// is a crank angle at which |OA| has its given value. Counts sign changes over a scan on both sides of the four-bar.
int modesByScan(const GrappleParameters& p, double distance, int samples) {
  const Planar d{p.od, 0.0}, e = p.oe * direction(p.doe), bc = p.ac * direction(p.bac) - Planar{p.ab, 0.0};
  int modes = 0;
  for (const double side : {-1.0, 1.0}) {
    const auto miss = [&](double psi) {
      const Planar b = d + p.bd * direction(psi), be = e - b;
      const double l = squaredNorm(be), along = (squaredNorm(bc) - p.ce * p.ce + l) / (2.0 * l);
      const double h_squared = squaredNorm(bc) / l - along * along;
      if (h_squared < 0.0) return std::nan("");
      const Planar to_c = along * be + side * std::sqrt(h_squared) * turned(be);
      return norm(b + to_c * ((-p.ab / squaredNorm(bc)) * conj(bc))) - distance;
    };
    double before = miss(0.0);
    for (int i = 1; i <= samples; ++i) {
      const double now = miss(2.0 * kPi * i / samples);
      modes += before * now < 0.0;
      before = now;
    }
  }
  return modes;
}

TEST(Branches, AreAsManyAsAScanOfTheConfigurationCurveFinds) {
  test::Random random(22);
  int with_six = 0, differing = 0;
  for (int i = 0; i < 400; ++i) {
    const GrappleParameters p = test::randomLinkage(random);
    const Planar a = pinA(p, random(-kPi, kPi));
    const Branches found = enumerateBranches(LeverGroup(p), a);
    with_six += found.count == 6;
    // A scan overlooks pairs closer than its step and pairs across the end of a side: look closer before judging.
    if (modesByScan(p, norm(a), 2000) == found.count || modesByScan(p, norm(a), 200000) == found.count) continue;
    ++differing;
    EXPECT_GT(found.count, modesByScan(p, norm(a), 200000)) << "linkage " << i << ": a mode is missing";
  }
  EXPECT_GT(with_six, 0);
  EXPECT_LE(differing, 5);  // the scan's own losses at the ends of its sides
}

TEST(Branches, SpecialTrianglesLoseNoMode) {
  test::Random random(23);
  for (int i = 0; i < 250; ++i) {
    GrappleParameters p = test::randomLinkage(random);
    const int kind = i % 4;
    const double scale = kind == 0 ? random(0.5, 2.0) : 1.0;  // similar, else congruent
    if (kind <= 2) {
      p.od = scale * p.ab;
      p.oe = scale * p.ac;
      p.doe = kind == 1 ? -p.bac : p.bac;  // 1: mirrored
    } else {
      p.bac = random.coin() ? 0.0 : kPi;
      p.doe = random.coin() ? 0.0 : kPi;
    }
    const Planar a = pinA(p, random(-kPi, kPi));
    const Branches found = enumerateBranches(LeverGroup(p), a);
    EXPECT_FALSE(found.self_motion);
    const int scanned = modesByScan(p, norm(a), 2000);
    EXPECT_TRUE(found.count == scanned || found.count >= modesByScan(p, norm(a), 200000)) << i;
  }
}

TEST(Branches, ParallelogramMovesByItself) {
  GrappleParameters p;
  p.o1 = {0.4, -0.8};
  p.o1a = 0.7;
  p.ab = p.od = 1.7;
  p.ac = p.oe = 1.3;
  p.bac = p.doe = 0.6;
  p.bp = 1.0;
  const Planar a = pinA(p, 0.3);
  p.bd = p.ce = norm(a);
  const LeverGroup group(p);
  EXPECT_TRUE(enumerateBranches(group, a).self_motion);
  // Any pose with theta2 = theta5 closes, and J is singular in each.
  for (double theta = -3.0; theta < 3.0; theta += 0.37) {
    const Closure closure = group.closure(group.pose(a, theta, theta));
    EXPECT_NEAR(closure.f1, 0.0, 1e-14);
    EXPECT_NEAR(closure.f2, 0.0, 1e-14);
    EXPECT_NEAR(closure.determinant, 0.0, 1e-14);
  }
  // Off the special place of A it is an ordinary linkage again.
  EXPECT_FALSE(enumerateBranches(group, pinA(p, 0.31)).self_motion);
}

}  // namespace
}  // namespace hammer_loads
