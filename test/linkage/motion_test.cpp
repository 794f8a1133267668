#include <gtest/gtest.h>

#include "hammer_loads/linkage/link_motion.h"
#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

using test::Real;

double relativeError(double value, const Real& exact) {
  return static_cast<double>(abs(Real(value) - exact) / abs(exact));
}

Real exactAngle(CrankAngle angle) {
  return angle.side == Side::kAfterBlow ? Real(angle.offset) : 2 * test::realPi() + Real(angle.offset);
}

/// Calls check at 1, 2.7 and 6.1 times 1e-1 ... 1e-12 rad on both sides of the blow.
template <typename Check>
void forOffsetsNearBlow(const Check& check) {
  for (int decade = 1; decade <= 12; ++decade) {
    for (double digit : {1.0, 2.7, 6.1}) {
      const double offset = digit * std::pow(10.0, -decade);
      check(CrankAngle{offset, Side::kAfterBlow});
      check(CrankAngle{-offset, Side::kBeforeBlow});
    }
  }
}

TEST(Motion, KeepsAllDigitsNearTheBlowForAnyMachine) {
  std::mt19937 random(7);
  double worst_u = 0.0, worst_du = 0.0, worst_sine = 0.0;
  for (int i = 0; i < 12; ++i) {
    const HammerParameters p = i == 0 ? test::mo100Parameters() : test::randomParameters(random);
    const Mechanism mechanism = test::mechanismOf(p);
    const test::NewtonEuler exact(p, Level::kRocker);
    forOffsetsNearBlow([&](CrankAngle angle) {
      const LinkMotion l = linkMotion(mechanism.linkage(), angle);
      const test::Reference at_speed = exact.at(angle, 1.0, 0.0, {});
      worst_u = std::max(worst_u, relativeError(l.rocker.u, at_speed.psi_rate));
      worst_du = std::max(worst_du, relativeError(l.rocker.du, at_speed.psi_accel));
      const Real transmission = at_speed.psi - at_speed.beta;
      for (double error :
           {relativeError(l.rocker.sin_psi, sin(at_speed.psi)), relativeError(l.sin_mu, sin(transmission)),
            relativeError(l.delta.im, sin(at_speed.beta - exactAngle(angle))),
            relativeError(l.v, at_speed.beta_rate)}) {
        worst_sine = std::max(worst_sine, error);
      }
    });
  }
  EXPECT_LE(worst_u, 1e-13);
  EXPECT_LE(worst_du, 1e-13);
  EXPECT_LE(worst_sine, 1e-12);  // the rod's rate and direction are differences
  std::printf("worst relative error near the blow: u %.2e, u' %.2e, rod %.2e\n", worst_u, worst_du, worst_sine);
}

TEST(Motion, IsExactOverTheWholeTurnForAnyMachine) {
  std::mt19937 random(8);
  double worst = 0.0;
  for (int i = 0; i < 6; ++i) {
    const HammerParameters p = test::randomParameters(random);
    const Mechanism mechanism = test::mechanismOf(p);
    const test::NewtonEuler exact(p, Level::kRocker);
    double u_peak = 0.0, du_peak = 0.0, u_error = 0.0, du_error = 0.0;
    for (double offset = -3.1; offset < 3.15; offset += 0.0937) {
      const CrankAngle angle = CrankAngle::fromOffset(offset);
      const LinkMotion l = linkMotion(mechanism.linkage(), angle);
      const test::Reference reference = exact.at(angle, 1.0, 0.0, {});
      u_peak = std::max(u_peak, std::abs(l.rocker.u));
      du_peak = std::max(du_peak, std::abs(l.rocker.du));
      u_error = std::max(u_error, std::abs(static_cast<double>(Real(l.rocker.u) - reference.psi_rate)));
      du_error = std::max(du_error, std::abs(static_cast<double>(Real(l.rocker.du) - reference.psi_accel)));
      EXPECT_NEAR(l.v, static_cast<double>(reference.beta_rate), 1e-13 * u_peak);
      EXPECT_NEAR(l.dv, static_cast<double>(reference.beta_accel), 1e-13 * du_peak + 1e-13);
      EXPECT_NEAR(rodAngle(l), static_cast<double>(reference.beta), 1e-14);
      EXPECT_NEAR(rockerAngle(l.rocker), static_cast<double>(reference.psi), 1e-14);
    }
    worst = std::max({worst, u_error / u_peak, du_error / du_peak});
  }
  EXPECT_LE(worst, 1e-13);
}

TEST(Motion, HasThePapersRatiosAtTheBlow) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const Motion before = motion(mechanism.linkage(), {0.0, Side::kBeforeBlow});
  const Motion after = motion(mechanism.linkage(), {0.0, Side::kAfterBlow});
  // P0 (4) at sin = 0, cos = -1 and 1: u = (1 - l0 +- l2 (l0 - 1)/sqrt(l2 l3/l0))/(l0 - 1)^2 with the ratios 1.625 ...
  const double root = std::sqrt(3.125 * 2.5 / 1.625);
  EXPECT_NEAR(before.u, (-1.0 - 3.125 / root) / 0.625, 1e-14);
  EXPECT_NEAR(after.u, (-1.0 + 3.125 / root) / 0.625, 1e-14);
  EXPECT_NEAR(before.u, -3.880, 5e-4);
  EXPECT_NEAR(after.u, 0.680, 5e-4);
  for (const Motion& m : {before, after}) {
    EXPECT_EQ(m.du, 0.0);
    EXPECT_EQ(m.sin_psi, 0.0);
    EXPECT_DOUBLE_EQ(m.cos_psi, 1.0);
  }
}

}  // namespace
}  // namespace hammer_loads
