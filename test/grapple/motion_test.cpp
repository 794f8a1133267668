#include <gtest/gtest.h>

#include <algorithm>

#include "grapple/explicit_curve.h"
#include "grapple/grapples.h"
#include "hammer_loads/grapple/grapple_motion.h"

namespace hammer_loads {
namespace {

constexpr double kPositions = 1e-12, kFirst = 1e-10, kSecond = 1e-8;  // required, relative to max(1, |value|)

void expectClose(double value, double expected, double tolerance, const std::string& what) {
  EXPECT_NEAR(value, expected, tolerance * std::max(1.0, std::abs(expected))) << what;
}

void expectClose(Planar value, Planar expected, double tolerance, const std::string& what) {
  expectClose(value.re, expected.re, tolerance, what + ".x");
  expectClose(value.im, expected.im, tolerance, what + ".y");
}

TEST(GrappleMotion, EqualsTheExplicitCurveToFiftyDigitsOverTheStroke) {
  for (const GrappleParameters& p : {test::claimsParameters(), test::straightParameters()}) {
    const Grapple grapple = test::grappleOf(p);
    test::CurveErrors errors;
    for (int i = 0; i <= 100; ++i) {
      const auto m = grapple.at(p.slider_closed + (p.slider_open - p.slider_closed) * i / 100.0);
      ASSERT_TRUE(m);
      const auto exact = test::exactPoseOf(p, *m);
      ASSERT_TRUE(exact) << i;
      errors.add(*m, *exact);
    }
    std::printf("relative errors over the stroke: P %.1e, dP/ds %.1e, d2P/ds2 %.1e\n", errors.position, errors.first,
                errors.second);
    EXPECT_LT(errors.position, kPositions);
    EXPECT_LT(errors.first, kFirst);
    EXPECT_LT(errors.second, kSecond);
  }
}

TEST(GrappleMotion, DerivativesGrowAsTheyMustBesideTheFold) {
  const GrappleParameters p = test::claimsParameters();
  const Grapple grapple = test::grappleOf(p);
  const double fold = grapple.upperLimit().slider;
  const auto near = [&](double distance) { return grapple.at(fold - distance).value(); };
  expectClose(near(1e-3).p, {2.6103473904, -2.1371200926}, 1e-10, "P at 1e-3");
  expectClose(near(1e-3).dp, {27.3281962562, 0.4906966365}, 1e-10, "dP/ds at 1e-3");
  expectClose(near(1e-4).dp, {80.36312, -0.77317}, 1e-5, "dP/ds at 1e-4");
  EXPECT_NEAR(near(1e-6).dp.re, 779.453, 1e-3);
  EXPECT_NEAR(near(1e-8).dp.re, 7770.7, 0.1);
  // det J falls with the root of the distance e and amplifies rounding: e^-1/2 in positions, then e^-1, then e^-2.
  for (const double distance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const GrappleMotion m = near(distance);
    const auto exact = test::exactPoseOf(p, m);
    ASSERT_TRUE(exact) << distance;
    test::CurveErrors errors;
    errors.add(m, *exact);
    EXPECT_LT(errors.position, 1e-14 / std::sqrt(distance)) << distance;
    EXPECT_LT(errors.first, 1e-13 / distance) << distance;
    EXPECT_LT(errors.second, 1e-13 / distance) << distance;
  }
}

TEST(GrappleMotion, TheOtherBranchIsReachedOnlyByItsOwnReference) {
  struct Other {
    double slider, theta2, theta5;
    Planar p;
    double determinant;
  };
  for (const Other& other : {Other{0.008, -0.3906348813625, -1.0095542441429, {2.3552560925, -2.6935947483}, 0.2056},
                             Other{0.332, -0.3102260546742, -0.7598561787355, {2.8852720043, -2.1766862237}, 0.1683}}) {
    GrappleParameters p = test::claimsParameters();
    p.reference_slider = other.slider;
    p.reference_ab = other.theta2 + 0.01;
    p.reference_od = other.theta5 - 0.01;
    const Grapple grapple = test::grappleOf(p);
    const auto m = grapple.at(other.slider);
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->theta2, other.theta2, 1e-12);
    EXPECT_NEAR(m->theta5, other.theta5, 1e-12);
    expectClose(m->p, other.p, 1e-10, "P");
    EXPECT_NEAR(m->determinant, other.determinant, 5e-5);
    EXPECT_NEAR(grapple.at(0.7331)->p.re, 2.67689, 5e-6);
    EXPECT_NEAR(test::grappleOf(test::claimsParameters()).at(0.7331)->p.re, 2.64702, 5e-6);
    EXPECT_NEAR(grapple.upperLimit().slider, 0.7331923934966, 1e-12);  // both branches end in the same fold
  }
}

TEST(GrappleMotion, TimeDerivativesEqualDifferencesAndTheLeftJawMirrorsThem) {
  const Grapple grapple = test::grappleOf(test::claimsParameters());
  const double speed = 0.3, acceleration = -1.7, step = 1e-4;
  const auto jawAt = [&](double t) {
    return rightJaw(*grapple.at(0.3 + speed * t + 0.5 * acceleration * t * t), speed + acceleration * t, acceleration);
  };
  const JawMotion before = jawAt(-step), now = jawAt(0.0), after = jawAt(step);
  // Central differences have the error step^2/6 times the third or fourth derivative, here below 100.
  const double tolerance = 100.0 * step * step;
  const auto difference = [&](double b, double a) { return (a - b) / (2.0 * step); };
  EXPECT_NEAR(now.edge_velocity.re, difference(before.edge.re, after.edge.re), tolerance);
  EXPECT_NEAR(now.edge_velocity.im, difference(before.edge.im, after.edge.im), tolerance);
  EXPECT_NEAR(now.edge_acceleration.re, difference(before.edge_velocity.re, after.edge_velocity.re), tolerance);
  EXPECT_NEAR(now.edge_acceleration.im, difference(before.edge_velocity.im, after.edge_velocity.im), tolerance);
  const auto jawDirection = [&](double t) {
    return grapple.linkDirections(*grapple.at(0.3 + speed * t + 0.5 * acceleration * t * t))[2].angle;
  };
  EXPECT_NEAR(now.turning_speed, difference(jawDirection(-step), jawDirection(step)), tolerance);
  EXPECT_NEAR(now.turning_acceleration, difference(before.turning_speed, after.turning_speed), tolerance);

  const JawMotion left = leftJaw(now);
  EXPECT_EQ(left.edge.re, -now.edge.re);
  EXPECT_EQ(left.edge.im, now.edge.im);
  EXPECT_EQ(left.edge_velocity.re, -now.edge_velocity.re);
  EXPECT_EQ(left.edge_velocity.im, now.edge_velocity.im);
  EXPECT_EQ(left.edge_acceleration.re, -now.edge_acceleration.re);
  EXPECT_EQ(left.edge_acceleration.im, now.edge_acceleration.im);
  EXPECT_EQ(left.turning_speed, -now.turning_speed);
  EXPECT_EQ(left.turning_acceleration, -now.turning_acceleration);
}

TEST(GrappleMotion, LinkDirectionsFollowTheirDerivatives) {
  const Grapple grapple = test::grappleOf(test::straightParameters());
  const double slider = -0.3, step = 1e-5;
  const auto before = grapple.linkDirections(*grapple.at(slider - step));
  const auto now = grapple.linkDirections(*grapple.at(slider));
  const auto after = grapple.linkDirections(*grapple.at(slider + step));
  for (std::size_t i = 0; i < now.size(); ++i)
    EXPECT_NEAR(now[i].d, (after[i].angle - before[i].angle) / (2.0 * step), 1e-8) << "link " << i + 1;
}

}  // namespace
}  // namespace hammer_loads
