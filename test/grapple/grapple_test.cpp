#include "hammer_loads/grapple/grapple.h"

#include <gtest/gtest.h>

#include <limits>

#include "grapple/grapples.h"
#include "hammer_loads/grapple/grapple_settings.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

/// Loads the claims set with one or more lines that override it.
auto loadClaimsWith(const std::string& lines) {
  const test::TemporaryFile over(lines + '\n');
  return loadGrapple({test::shippedFile("grapple_claims.yaml"), over.path()});
}

bool mentions(const std::vector<std::string>& problems, const std::string& text) {
  for (const std::string& problem : problems) {
    if (problem.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(GrappleFile, ReportsEveryProblemAtOnce) {
  const auto result = loadClaimsWith("gh_length_m: -1\nab_length_m: long\ndrive_sign: 0\ngh_lenght_m: 1.25");
  EXPECT_FALSE(result.value);
  EXPECT_EQ(result.problems.size(), 4u);
  EXPECT_TRUE(mentions(result.problems, "gh_length_m: -1 m, must be > 0"));
  EXPECT_TRUE(mentions(result.problems, "ab_length_m: long m"));
  EXPECT_TRUE(mentions(result.problems, "drive_sign: 0, must be 1 or -1"));
  EXPECT_TRUE(mentions(result.problems, "gh_lenght_m: unknown key, perhaps gh_length_m"));
}

TEST(GrappleFile, MissingKeysHaveNoDefault) {
  const test::TemporaryFile alone("gh_length_m: 1.25\n");
  const auto result = loadGrapple({alone.path()});
  EXPECT_FALSE(result.value);
  EXPECT_EQ(result.problems.size(), 23u);
  EXPECT_TRUE(mentions(result.problems, "drive_sign: missing"));
  EXPECT_FALSE(loadGrapple({"/nonexistent.yaml"}).value);
}

TEST(GrappleFile, NamesTheLimitThatAStrokePasses) {
  const auto beyond_fold = loadClaimsWith("slider_open_m: 0.74");
  EXPECT_FALSE(beyond_fold.value);
  EXPECT_TRUE(mentions(beyond_fold.problems, "slider_open_m: 0.74 m"));
  EXPECT_TRUE(mentions(beyond_fold.problems, "fold at 0.7331923934967 m"));
  const auto beyond_dead_centre = loadClaimsWith("slider_closed_m: -0.3");
  EXPECT_TRUE(mentions(beyond_dead_centre.problems, "dead centre at -0.27 m"));
  EXPECT_TRUE(mentions(loadClaimsWith("slider_closed_m: -0.1").problems, "jaws would overlap"));
  EXPECT_TRUE(mentions(loadClaimsWith("slider_open_m: 0.005\nslider_closed_m: 0.3").problems,
                       "slider_open_m: 0.005 m, must put the jaw edge farther out"));
}

TEST(GrappleFile, NamesThePosesWhenTheReferenceIsNone) {
  const auto none = loadClaimsWith("reference_ab_angle_rad: 1.5");
  EXPECT_FALSE(none.value);
  EXPECT_TRUE(mentions(none.problems, "(0.378626, -0.648949)"));
  EXPECT_TRUE(mentions(loadClaimsWith("reference_slider_m: 2.0").problems, "out of reach"));
  EXPECT_TRUE(mentions(loadClaimsWith("reference_slider_m: 0.8").problems, "there is none"));
  EXPECT_TRUE(mentions(loadClaimsWith("reference_slider_m: 0.8").problems, "reference_slider_m = 0.8 m"));
}

TEST(Grapple, RefusesValuesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  GrappleParameters p = test::claimsParameters();
  p.dbp = nan;
  p.od = std::numeric_limits<double>::infinity();
  const Checked<Grapple> grapple = Grapple::make(p);
  EXPECT_FALSE(grapple.value);
  EXPECT_EQ(grapple.problems.size(), 2u);
}

TEST(Grapple, TakesTheNearestPoseAsReferenceBesideAFold) {
  const GrappleParameters p = test::claimsParameters();
  const double slider = 0.7331;  // the other branch lies 0.012 rad away
  const GrappleMotion working = *test::grappleOf(p).at(slider);
  GrappleParameters beside = p;
  beside.reference_slider = slider;
  beside.reference_ab = working.theta2;
  beside.reference_od = working.theta5;
  EXPECT_NEAR(test::grappleOf(beside).at(0.332)->p.re, 0.802384681896094, 1e-12);
}

TEST(Grapple, ParallelogramAtTheReferenceIsRefused) {
  GrappleParameters p = test::claimsParameters();
  const double slider = 0.332;
  const Planar a = test::grappleOf(p).at(slider)->a;
  p.od = p.ab;
  p.oe = p.ac;
  p.doe = p.bac = 0.3;
  p.bd = p.ce = norm(a);
  p.reference_ab = p.reference_od = 0.2;
  const Checked<Grapple> grapple = Grapple::make(p);
  EXPECT_FALSE(grapple.value);
  EXPECT_TRUE(mentions(grapple.problems, "can move with the slider held"));
}

}  // namespace
}  // namespace hammer_loads
