#include "hammer_loads/grapple/branches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

struct Angles {
  double theta2{}, theta5{};
};

using test::apart;

bool contains(const Branches& branches, const Angles& expected, double tolerance) {
  return std::any_of(branches.branch.begin(), branches.branch.begin() + branches.count, [&](const auto& b) {
    return apart(b.theta2, expected.theta2) < tolerance && apart(b.theta5, expected.theta5) < tolerance;
  });
}

Planar pinA(const GrappleParameters& p, double theta1) { return p.o1 + p.o1a * direction(theta1); }

TEST(Branches, FindsAllSixOfTheSixModeCase) {
  const GrappleParameters p = test::sixModeLinkage();
  const Branches found = enumerateBranches(LeverGroup(p), pinA(p, 0.4));
  ASSERT_EQ(found.count, 6);
  EXPECT_FALSE(found.self_motion);
  // Reference values computed independently by Newton's method to 40 digits.
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

/// Counts modes without the polynomial, as sign changes over a scan on both sides of a four-bar. Seen from link 5, the
/// jaw's side DB is the crank of D-B-C-E. A mode is a crank angle at which |OA| has its given value.
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
    // A scan misses pairs closer than its step and pairs across the end of a side, so a finer scan decides.
    if (modesByScan(p, norm(a), 2000) == found.count || modesByScan(p, norm(a), 200000) == found.count) continue;
    ++differing;
    EXPECT_GT(found.count, modesByScan(p, norm(a), 200000)) << "linkage " << i << ": a mode is missing";
  }
  EXPECT_GT(with_six, 0);
  EXPECT_LE(differing, 5);  // modes that the scan misses at the ends of its sides
}

TEST(Branches, SpecialTrianglesLoseNoMode) {
  test::Random random(23);
  for (int i = 0; i < 250; ++i) {
    GrappleParameters p = test::randomLinkage(random);
    const int kind = i % 4;
    const double scale = kind == 0 ? random(0.5, 2.0) : 1.0;  // similar triangles, else congruent
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

}  // namespace
}  // namespace hammer_loads
