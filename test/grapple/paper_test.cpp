/// Results of the paper's printed formulas compared with the correct ones.
#include <gtest/gtest.h>

#include <algorithm>

#include "grapple/grapples.h"

namespace hammer_loads {
namespace {

TEST(GebelsFormulas, FailWhereTheErrataStateIt) {
  const GrappleParameters p = test::claimsParameters();
  const Grapple grapple = test::grappleOf(p);
  // Z_O^-1 is printed with + sin in the second row: it does not keep |A|, and is singular at phi_OD = -45 deg.
  const GrappleMotion m = *grapple.at(0.332);
  const double c = std::cos(m.theta5), s = std::sin(m.theta5);
  const Planar inverted{c * m.a.re + s * m.a.im, -s * m.a.re + c * m.a.im};
  const Planar printed{c * m.a.re + s * m.a.im, s * m.a.re + c * m.a.im};
  EXPECT_NEAR(inverted.re, 1.504911698719, 2e-12);
  EXPECT_NEAR(inverted.im, -0.826129984765, 2e-12);
  EXPECT_NEAR(printed.re, 1.504911698719, 2e-12);
  EXPECT_NEAR(printed.im, -1.671882267267, 2e-12);
  EXPECT_NEAR(norm(inverted), 1.716755653163, 1e-12);
  EXPECT_NEAR(norm(inverted), norm(m.a), 1e-15);
  const GrappleMotion at_45 = *grapple.at(0.178894907739);
  EXPECT_NEAR(at_45.theta5, -kPi / 4, 1e-11);
  EXPECT_GT(std::abs(at_45.determinant), 0.1);  // only the printed matrix is singular there
  // phi_O1A = arccos(...) + phi_HO1A lacks the direction of O1G and the sign of the closure.
  const Planar g = m.g - p.o1;
  const double bracket = std::acos((p.o1h * p.o1h + squaredNorm(g) - p.gh * p.gh) / (2.0 * norm(g) * p.o1h));
  EXPECT_NEAR(bracket, 1.301980, 5e-7);
  EXPECT_NEAR(angleOf(m.h - p.o1), 0.268816, 5e-7);
  EXPECT_NEAR(kPi / 2 - bracket, angleOf(m.h - p.o1), 1e-14);
  // arctg in place of atan2 is off by pi while P lies inside of B or A.
  const GrappleMotion closed = *grapple.at(0.008);
  EXPECT_NEAR(angleOf(closed.p - closed.b), -2.626708, 5e-7);
  EXPECT_NEAR(std::atan((closed.p - closed.b).im / (closed.p - closed.b).re), 0.514884, 5e-7);
  EXPECT_NEAR(angleOf(closed.p - closed.a), -2.094934, 5e-7);
  EXPECT_NEAR(std::atan((closed.p - closed.a).im / (closed.p - closed.a).re), 1.046659, 5e-7);
}

/// Follows the paper's chain: P on a line, A from link 1, B by triangle ABP, D on link 3. E and C would then have to
/// keep their distances. Returns the largest errors of |OD| and |CE|.
std::pair<double, double> missesOnTheLine(const GrappleParameters& p, double height, double x_most) {
  const Grapple grapple = test::grappleOf(p);
  double miss_od = 0.0, miss_ce = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const GrappleMotion m = *grapple.at(p.slider_closed + (p.slider_open - p.slider_closed) * i / 400.0);
    if (m.p.re > x_most) break;
    const Planar ap = Planar{m.p.re, height} - m.a;
    const double at_a = std::acos((squaredNorm(ap) + p.ab * p.ab - p.bp * p.bp) / (2.0 * norm(ap) * p.ab));
    const double theta2 = angleOf(ap) + at_a;
    const Planar b = m.a + p.ab * direction(theta2), c = m.a + p.ac * direction(theta2 + p.bac);
    const Planar d = b + p.bd * direction(angleOf(m.a + ap - b) - p.dbp);
    const Planar e = p.oe * direction(angleOf(d) + p.doe);
    miss_od = std::max(miss_od, std::abs(norm(d) - p.od));
    miss_ce = std::max(miss_ce, std::abs(norm(e - c) - p.ce));
  }
  return {miss_od, miss_ce};
}

TEST(GebelsFormulas, APathDemandedStraightStretchesTheLinks) {
  const auto midBand = [](const GrappleParameters& p, double x_most) {
    const Grapple grapple = test::grappleOf(p);
    double low = 0.0, high = -10.0;
    for (int i = 0; i <= 4000; ++i) {
      const GrappleMotion m = *grapple.at(p.slider_closed + (p.slider_open - p.slider_closed) * i / 4000.0);
      if (m.p.re > x_most) break;
      low = std::min(low, m.p.im);
      high = std::max(high, m.p.im);
    }
    return 0.5 * (low + high);
  };
  const GrappleParameters claims = test::claimsParameters(), straight = test::straightParameters();
  const auto [claims_od, claims_ce] = missesOnTheLine(claims, midBand(claims, 1.6), 1.6);
  EXPECT_NEAR(claims_od, 0.0266, 5e-5);
  EXPECT_NEAR(claims_ce, 0.005, 5e-4);
  const auto [straight_od, straight_ce] = missesOnTheLine(straight, midBand(straight, 1.15), 1.15);
  EXPECT_NEAR(straight_od, 0.0037, 5e-5);
  EXPECT_NEAR(straight_ce, 0.0012, 5e-5);
}

}  // namespace
}  // namespace hammer_loads
