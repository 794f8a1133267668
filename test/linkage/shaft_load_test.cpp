#include "hammer_loads/linkage/shaft_load.h"

#include <gtest/gtest.h>

#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

constexpr Gravity kGravity{3.1, -9.3};

TEST(ShaftLoad, EnergyAndWeightEqualTheReference) {
  std::mt19937 random(21);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (int i = 0; i < 5; ++i) {
      const HammerParameters p = i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random);
      const Mechanism mechanism = test::mechanismOf(p);
      const test::NewtonEuler exact(p, level);
      for (double offset = -3.1; offset < 3.1; offset += 0.243) {
        const CrankAngle angle = CrankAngle::fromOffset(offset);
        const ShaftLoad load = shaftLoad(mechanism, level, angle, kGravity);
        const test::Reference reference = exact.at(angle, 1.0, 0.0, kGravity);
        const double inertia = static_cast<double>(2 * reference.kinetic_energy);
        EXPECT_NEAR(load.inertia, inertia, 1e-13 * inertia);
        const double torque = static_cast<double>(reference.weight_power);
        const double torque_scale = p.rocker_mass * 10.0 * (p.lengths.rod + p.rocker_com_distance) * 4.0;
        EXPECT_NEAR(load.weight_torque, torque, 1e-14 * torque_scale);
      }
    }
  }
}

TEST(ShaftLoad, SlopesAreDerivatives) {
  std::mt19937 random(22);
  const double h = 1e-3;
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (int i = 0; i < 5; ++i) {
      const HammerParameters p = i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random);
      const Mechanism mechanism = test::mechanismOf(p);
      double inertia_scale = 0.0, torque_scale = 0.0;
      for (double offset = -3.1; offset < 3.1; offset += 0.1) {
        const ShaftLoad load = shaftLoad(mechanism, level, CrankAngle::fromOffset(offset), kGravity);
        inertia_scale = std::max(inertia_scale, load.inertia);
        torque_scale = std::max(torque_scale, std::abs(load.weight_torque));
      }
      for (double offset = -3.1; offset < 3.1; offset += 0.143) {
        const Side side = offset < 0.0 ? Side::kBeforeBlow : Side::kAfterBlow;
        const auto at = [&](double shift) { return shaftLoad(mechanism, level, {offset + shift, side}, kGravity); };
        const auto slope = [&](auto member) {
          return (8.0 * (at(h).*member - at(-h).*member) - (at(2 * h).*member - at(-2 * h).*member)) / (12.0 * h);
        };
        const ShaftLoad load = at(0.0);
        EXPECT_NEAR(2.0 * load.half_inertia_slope, slope(&ShaftLoad::inertia), 1e-6 * inertia_scale);
        EXPECT_NEAR(load.weight_torque_slope, slope(&ShaftLoad::weight_torque), 1e-6 * torque_scale);
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads
