#include "hammer_loads/linkage/mechanism.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

struct Violation {
  const char* key;
  double HammerParameters::*member;
  double value;
  const char* rule;
};

std::vector<Violation> violations() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  using P = HammerParameters;
  return {{"rocker_com_distance_m", &P::rocker_com_distance, 0.0, "> 0"},
          {"rocker_com_angle_deg", &P::rocker_com_angle, kNan, "finite"},
          {"rocker_mass_kg", &P::rocker_mass, -35.2, "> 0"},
          {"rocker_inertia_about_pivot_kg_m2", &P::rocker_inertia_about_pivot, 0.0, "> 0"},
          {"rocker_inertia_about_pivot_kg_m2", &P::rocker_inertia_about_pivot, 0.3415, ">= rocker mass"},
          {"striking_distance_m", &P::striking_distance, -1.0, "> 0"},
          {"striking_offset_m", &P::striking_offset, kNan, "finite"},
          {"striking_friction", &P::striking_friction, -0.1, ">= 0"},
          {"crank_mass_kg", &P::crank_mass, -1.0, ">= 0"},
          {"crank_com_along_m", &P::crank_com_along, kNan, "finite"},
          {"crank_com_across_m", &P::crank_com_across, kNan, "finite"},
          {"crank_inertia_about_com_kg_m2", &P::crank_inertia_about_com, -1.0, ">= 0"},
          {"rod_mass_kg", &P::rod_mass, -1.0, ">= 0"},
          {"rod_com_along_m", &P::rod_com_along, kNan, "finite"},
          {"rod_com_across_m", &P::rod_com_across, kNan, "finite"},
          {"rod_inertia_about_com_kg_m2", &P::rod_inertia_about_com, -1.0, ">= 0"},
          {"drive_inertia_kg_m2", &P::drive_inertia, 0.0, "> 0"}};
}

TEST(Mechanism, EveryRuleIsReportedWithKeyValueAndWhatIsAllowed) {
  for (const Violation& violation : violations()) {
    HammerParameters p = test::mo100LinkageParameters();
    EXPECT_TRUE(Mechanism::make(p).value);
    p.*violation.member = violation.value;
    const Checked<Mechanism> made = Mechanism::make(p);
    EXPECT_FALSE(made.value) << violation.key;
    ASSERT_EQ(made.problems.size(), 1u) << violation.key;
    EXPECT_EQ(made.problems[0].find(std::string(violation.key) + ": "), 0u) << made.problems[0];
    EXPECT_NE(made.problems[0].find(violation.rule), std::string::npos) << made.problems[0];
    p.*violation.member = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(Mechanism::make(p).value) << violation.key;
  }
}

TEST(Mechanism, ReportsAllViolationsTogetherWithThoseOfTheLinkage) {
  HammerParameters p = test::mo100Parameters();
  p.lengths.rod = 0.16;
  p.rocker_mass = -1.0;
  p.striking_friction = -1.0;
  const Checked<Mechanism> made = Mechanism::make(p);
  EXPECT_EQ(made.problems.size(), 3u);
}

TEST(Mechanism, KeepsParametersWithTheRodCorrected) {
  HammerParameters p = test::mo100Parameters();
  p.lengths.rod = 0.15004;
  const Checked<Mechanism> made = Mechanism::make(p);
  ASSERT_TRUE(made.value);
  EXPECT_EQ(made.notes.size(), 1u);
  EXPECT_NEAR(made.value->parameters().lengths.rod, 0.150, 1e-15);
  EXPECT_NEAR(made.value->rockerFirstMoment(), 35.2 * 0.106, 1e-15);
}

TEST(Mechanism, MassesAtRestHaveTheNominalFirstMoment) {
  // At the blow, crank, rod and rocker lie on the xi axis. Mass times position from D is summed by hand.
  const HammerParameters p = test::mo100LinkageParameters();
  const Mechanism mechanism = test::mechanismOf(p);
  const LinkMoments& k = mechanism.moments();
  const double xi = p.crank_mass * (p.crank_com_along - 0.078) + p.rod_mass * (0.048 + p.rod_com_along - 0.078) +
                    p.rocker_mass * p.rocker_com_distance * std::cos(p.rocker_com_angle);
  const double eta = p.crank_mass * p.crank_com_across + p.rod_mass * p.rod_com_across +
                     p.rocker_mass * p.rocker_com_distance * std::sin(p.rocker_com_angle);
  const Planar sum = k.fixed + k.crank + k.rod + Planar{k.rocker, 0.0};
  const double c = std::cos(p.rocker_com_angle), s = std::sin(p.rocker_com_angle);
  EXPECT_NEAR(sum.re, c * xi + s * eta, 1e-15);
  EXPECT_NEAR(sum.im, -s * xi + c * eta, 1e-15);
  EXPECT_NEAR(k.mass, 45.7, 1e-13);
}

}  // namespace
}  // namespace hammer_loads
