#include "hammer_loads/hammer/hull_model.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "hammer_loads/hammer/pulse.h"
#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

TEST(HullWrench, MomentumEqualsTheReference) {
  std::mt19937 random(44);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    const HammerParameters p = test::randomParameters(random);
    const Mechanism mechanism = test::mechanismOf(p);
    const test::NewtonEuler exact(p, level);
    for (double offset = -3.1; offset < 3.1; offset += 0.4) {
      const CrankAngle angle = CrankAngle::fromOffset(offset);
      const LinkMomentum momentum = linkMomentum(mechanism, level, angle, 7.0);
      const test::Reference reference = exact.at(angle, 7.0, 0.0, {});
      const double scale = p.rocker_mass * 7.0 * (p.lengths.rod + p.rocker_com_distance) * 4.0;
      EXPECT_NEAR(momentum.x, static_cast<double>(reference.momentum.x), 1e-14 * scale);
      EXPECT_NEAR(momentum.z, static_cast<double>(reference.momentum.y), 1e-14 * scale);
      EXPECT_NEAR(momentum.about_d, static_cast<double>(reference.momentum_about_d),
                  1e-14 * scale * p.lengths.rod * 4.0);
    }
  }
}

TEST(LevelPulse, KeepsPeakAndImpulseOfTheRockersLastLobeAtAnySpeed) {
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  std::mt19937 random(71);
  for (int i = 0; i < 6; ++i) {
    const Mechanism mechanism = test::mechanismOf(i == 0 ? test::mo100Parameters() : test::randomParameters(random));
    const HullModel model(mechanism, Level::kPulse);
    for (double w : {0.5, 13.6, 200.0}) {
      const HalfSinePulse rocker = pulseAtConstantSpeed(mechanism, Level::kRocker, w, {}).pulse;
      const double length = model.nominalPulse().length;
      const auto force = [&](double left) {
        const CrankAngle angle =
            left < kPi ? CrankAngle{-left, Side::kBeforeBlow} : CrankAngle{2.0 * kPi - left, Side::kAfterBlow};
        return hullWrench(model, {angle, w, 0.0}, {}).force_z;
      };
      EXPECT_NEAR(force(0.5 * length), rocker.amplitude, 1e-11 * rocker.amplitude);
      const double impulse = Quadrature::integrate(force, 0.0, length, 8, 1e-12) / w;
      EXPECT_NEAR(impulse, rocker.impulse, 1e-10 * rocker.impulse);
    }
  }
}

TEST(LevelPulse, EqualsTheRockerAlongTheToolAsTheSpeedVanishes) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kPulse);
  const Gravity gravity{3.0, -9.3};
  for (double phi = 0.1; phi < 6.28; phi += 0.1) {
    const CrankMotion crank{CrankAngle::fromAngle(phi), 1e-9, 0.0};
    EXPECT_NEAR(hullWrench(model, crank, gravity).force_z,
                hullWrench(mechanism, Level::kRocker, crank, gravity).force_z, 1e-10);
  }
}

TEST(LevelPulse, MomentumDifferenceIsTheImpulse) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  const HullModel model(mechanism, Level::kPulse);
  using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
  const double w = 25.0;
  for (const auto& [from, to] :
       {std::pair{-1.5, -0.1}, std::pair{-0.4, -0.2}, std::pair{-3.0, -1.0}, std::pair{-0.3, 0.0}}) {
    const double impulse = Quadrature::integrate(
                               [&](double x) {
                                 return hullWrench(model, {{x, Side::kBeforeBlow}, w, 0.0}, {}).force_z;
                               },
                               from, to, 15, 1e-12) /
                           w;
    const double change =
        linkMomentum(model, {to, Side::kBeforeBlow}, w).z - linkMomentum(model, {from, Side::kBeforeBlow}, w).z;
    EXPECT_NEAR(impulse, -change, 1e-8) << from;
  }
  EXPECT_EQ(linkMomentum(model, {0.0, Side::kAfterBlow}, w).z, 0.0);
}

}  // namespace
}  // namespace hammer_loads
