// Random bucket linkages compared with closure by Newton's method and with the equilibrium of every link. Boom files
// with an impossible linkage are refused.
#include "hammer_loads/boom/bucket_linkage.h"

#include <gtest/gtest.h>

#include "boom/booms.h"
#include "boom/linkage_reference.h"

namespace hammer_loads {
namespace {

using test::LinkageReference;

struct RandomLinkage {
  BucketLinkage::Pins pins;
  BucketLinkageParameters lengths;
  double angle;
};

/// Returns a random linkage like that of a bucket, at an angle at which guide and coupler are 15 to 165 deg apart.
RandomLinkage randomLinkage(std::mt19937& random) {
  for (;;) {
    const auto point = [&](double size) {
      return Eigen::Vector2d(test::between(random, -size, size), test::between(random, -size, size));
    };
    RandomLinkage made{
        {point(2.0), point(0.6), point(0.5), test::between(random, -1.0, 1.0) > 0.0 ? 1.0 : -1.0}, {}, {}};
    made.lengths.guide_length = test::between(random, 0.15, 0.6);
    made.lengths.coupler_length = test::between(random, 0.15, 0.6);
    made.lengths.branch = test::between(random, -1.0, 1.0) > 0.0 ? 1.0 : -1.0;
    made.angle = test::between(random, -3.0, 3.0);
    const LinkageReference reference(made.pins, made.lengths);
    const double g = made.lengths.guide_length, c = made.lengths.coupler_length,
                 d = static_cast<double>((reference.drivenPin(made.angle) - reference.pivot).norm()),
                 cosine = (g * g + c * c - d * d) / (2.0 * g * c);
    if (std::abs(cosine) > std::cos(0.26) || made.pins.driven.norm() < 0.1) continue;
    if (reference.length(made.angle) > 0.3L) return made;
  }
}

TEST(BucketLinkages, LengthAndLeverAreThoseOfAnIndependentClosure) {
  std::mt19937 random(71);
  double worst_length = 0.0, worst_arm = 0.0, worst_rate = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const RandomLinkage r = randomLinkage(random);
    const BucketLinkage linkage(r.pins, r.lengths);
    const LinkageReference reference(r.pins, r.lengths);
    const BucketLinkagePosition at = linkage.at(std::cos(r.angle), std::sin(r.angle));
    ASSERT_TRUE(at.closed);
    // The branch is the side of the line from pivot to driven pin on which the reference's guide lies.
    const LinkageReference::Point across = reference.drivenPin(r.angle) - reference.pivot,
                                  guide = reference.rodPin(r.angle) - reference.pivot;
    ASSERT_GT(static_cast<double>(LinkageReference::moment(across, guide)) * r.lengths.branch, 0.0) << i;
    const auto arm = [&](long double q) {
      return static_cast<long double>(
          linkage.at(std::cos(static_cast<double>(q)), std::sin(static_cast<double>(q))).arm);
    };
    worst_length = std::max(worst_length, std::abs(at.length - static_cast<double>(reference.length(r.angle))));
    worst_arm = std::max(
        worst_arm, std::abs(at.arm - static_cast<double>(reference.arm(r.angle))) / std::max(1.0, std::abs(at.arm)));
    worst_rate =
        std::max(worst_rate, std::abs(at.arm_rate - static_cast<double>(LinkageReference::slope(arm, r.angle))) /
                                 std::max(1.0, std::abs(at.arm_rate)));
  }
  EXPECT_LT(worst_length, 1e-12);
  EXPECT_LT(worst_arm, 1e-12);
  EXPECT_LT(worst_rate, 1e-9);
}

TEST(BucketLinkages, PinForcesAreThoseOfEveryLinksEquilibriumAndDoTheJointsWork) {
  std::mt19937 random(72);
  double worst = 0.0, worst_work = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const RandomLinkage r = randomLinkage(random);
    const BucketLinkage linkage(r.pins, r.lengths);
    const LinkageReference::Forces expected = LinkageReference(r.pins, r.lengths).forces(r.angle);
    const BucketLinkagePosition at = linkage.at(std::cos(r.angle), std::sin(r.angle));
    const BucketLinkageForces f = linkage.forces(at.rod_pin, at.driven_pin);
    const double size = 1.0 + f.coupler.norm();
    const auto off = [&](const Eigen::Vector2d& got, const LinkageReference::Point& want) {
      worst = std::max(worst, (got + want.cast<double>()).norm() / size);  // opposite at both ends of a link
    };
    off(f.rod, expected.base), off(f.guide, expected.pivot), off(f.coupler, expected.driven);
    // A push of 1 N does the work arm dq on the joint.
    const double torque = r.pins.sense * (at.driven_pin.y() * -f.coupler.x() - at.driven_pin.x() * -f.coupler.y());
    worst_work = std::max(worst_work, std::abs(torque - at.arm) / std::max(1.0, std::abs(at.arm)));
  }
  EXPECT_LT(worst, 1e-10);
  EXPECT_LT(worst_work, 1e-12);
}

class ShippedLinkage : public testing::Test {
 protected:
  ShippedLinkage()
      : given_(test::shippedBoomParameters().cylinders.back()), chain_(*Chain::make(test::shippedUrdf(), {}).value) {}
  std::string problem(const CylinderParameters& p) const {
    const Checked<Cylinder> made = Cylinder::make(p, 1e9, chain_);
    EXPECT_FALSE(made.value);
    EXPECT_EQ(made.problems.size(), 1U);
    return made.problems.empty() ? "" : made.problems.front();
  }
  CylinderParameters given_;
  Chain chain_;
};

TEST_F(ShippedLinkage, TakesTheBranchThatFitsTheStroke) {
  ASSERT_TRUE(given_.linkage);
  const Cylinder cylinder = *Cylinder::make(given_, 1e9, chain_).value;
  EXPECT_EQ(cylinder.parameters().linkage->branch, -1.0);
  for (double q = -1.9; q <= 0.1; q += 0.02) {
    const CylinderPosition at = cylinder.at(q);
    EXPECT_GE(at.length, given_.closed_length);
    EXPECT_LE(at.length, given_.closed_length + given_.stroke);
    EXPECT_FALSE(at.zero_moment_arm);
    EXPECT_GT(at.arm, 0.1);  // extending turns the tool towards the machine
  }
}

TEST_F(ShippedLinkage, RefusesWhatCannotBeWithKeyValueAndRule) {
  CylinderParameters p = given_;
  p.linkage->coupler_length = 0.10;
  EXPECT_EQ(problem(p).find("hammer_cylinder_coupler_length_m: 0.1 m, cannot close the linkage: at hammer_joint = "),
            0U);
  EXPECT_NE(problem(p).find("must be from "), std::string::npos);
  p = given_;
  p.linkage->branch = 1.0;
  EXPECT_EQ(problem(p).find("hammer_cylinder_closed_length_m: 0.84 m, cannot close the linkage: at hammer_joint = "),
            0U);
  p = given_;
  p.linkage->branch = 0.5;
  EXPECT_EQ(problem(p), "hammer_cylinder_linkage_branch: 0.5, must be 1 or -1");
  p = given_;
  p.linkage->guide_length = 0.0;
  EXPECT_EQ(problem(p), "hammer_cylinder_rocker_link_length_m: 0 m, must be from 1e-06 to 1000 m");
  p = given_;
  p.rod_x = p.rod_z = 0.0;
  EXPECT_EQ(problem(p), "hammer_cylinder_joint: hammer_joint, an anchor lies on its axis, must be beside it");
  p = given_;
  p.closed_length = 0.61, p.stroke = 0.60, p.joint = "swing_joint";
  EXPECT_EQ(
      problem(p),
      "hammer_cylinder_linkage: bucket, swing_joint must turn about y, with its origin at y = 0 of the link before");
}

TEST_F(ShippedLinkage, AsksForTheBranchWhereTheStrokeFitsBoth) {
  CylinderParameters p = given_;
  p.closed_length = 1.1, p.stroke = 1.0, p.base_x = -0.25;  // fits both branches
  EXPECT_EQ(problem(p),
            "hammer_cylinder_linkage_branch: not given, must be 1 or -1: closed length and stroke fit both");
  p.linkage->branch = 1.0;
  EXPECT_TRUE(Cylinder::make(p, 1e9, chain_).value);
}

TEST_F(ShippedLinkage, IsADeadCentreWhereItsLinksDoNotReachEachOther) {
  CylinderParameters p = given_;
  const Cylinder cylinder = *Cylinder::make(p, 1e9, chain_).value;
  int open = 0;
  for (double q = -3.1; q <= 3.1; q += 0.01) {
    const CylinderPosition at = cylinder.at(q);
    EXPECT_TRUE(std::isfinite(at.length) && std::isfinite(at.arm)) << q;
    const CylinderForce load = cylinder.load(at, 1e4);
    EXPECT_EQ(std::isnan(load.force), at.zero_moment_arm);
    EXPECT_TRUE(std::isfinite(cylinder.jointStiffness(at)));
    open += at.zero_moment_arm ? 1 : 0;
  }
  EXPECT_GT(open, 0);
}

TEST_F(ShippedLinkage, KeysOfTheBoomFileAreRequiredTogether) {
  const std::string text = test::textOf(test::sourceFile("config/boom_eo2621.yaml"));
  const auto problemsOf = [&](const std::string& yaml) {
    std::vector<std::string> problems;
    ParameterReader reader(*parameterMap(YAML::Load(yaml), {}, problems));
    readBoomParameters(reader);
    reader.reportUnknownKeys();
    return reader.problems();
  };
  EXPECT_TRUE(problemsOf(text).empty());
  const auto without = [&](const std::string& key) {
    const std::size_t at = text.find(key);
    return text.substr(0, at) + text.substr(text.find('\n', at) + 1);
  };
  ASSERT_EQ(problemsOf(without("hammer_cylinder_coupler_length_m")).size(), 1U);
  EXPECT_EQ(problemsOf(without("hammer_cylinder_coupler_length_m")).front().find("hammer_cylinder_coupler_length_m"),
            0U);
  EXPECT_EQ(problemsOf(without("hammer_cylinder_linkage:")).size(), 4U);  // the linkage's keys are then unknown
  EXPECT_FALSE(problemsOf(test::withFirstReplaced(text, "linkage: bucket", "linkage: dogbone")).empty());
}

}  // namespace
}  // namespace hammer_loads
