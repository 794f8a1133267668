#include "hammer_loads/linkage/shaft_load.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "support/csv.h"
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

TEST(ShaftLoad, WeightDoesNoWorkOverATurn) {
  // rocker and all links return to where they were
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 31>;
    const auto torque = [&](Side side) {
      return [&, side](double x) { return shaftLoad(mechanism, level, {x, side}, kGravity).weight_torque; };
    };
    const double work = Quadrature::integrate(torque(Side::kAfterBlow), 0.0, kPi, 12, 1e-12) +
                        Quadrature::integrate(torque(Side::kBeforeBlow), -kPi, 0.0, 12, 1e-12);
    EXPECT_NEAR(work, 0.0, 1e-9) << static_cast<int>(level);
  }
}

TEST(ShaftLoad, DriveTorqueEqualsTheReferenceTables) {
  for (const auto& [name, level] :
       {std::pair{"mo100_constant_speed.csv", Level::kRocker}, std::pair{"mo100_linkage.csv", Level::kLinkage}}) {
    const test::Csv csv = test::dataCsv(name);
    const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
    const double peak = csv.peak("drive_torque_y_Nm");
    for (std::size_t i = 0; i < csv.size(); ++i) {
      const double g = csv.number(i, "gravity_m_s2"), pitch = csv.number(i, "hull_pitch_rad");
      const ShaftLoad load = shaftLoad(mechanism, level, CrankAngle::fromAngle(csv.number(i, "crank_angle_rad")),
                                       {g * std::sin(pitch), -g * std::cos(pitch)});
      EXPECT_NEAR(test::driveTorque(load, csv.number(i, "crank_speed_rad_s"), csv.number(i, "crank_accel_rad_s2")),
                  csv.number(i, "drive_torque_y_Nm"), 1e-12 * peak)
          << name << ' ' << i;
    }
  }
}

TEST(ShaftLoad, MasslessCrankAndRodLeaveTheRocker) {
  HammerParameters p = test::mo100LinkageParameters();
  p.crank_mass = p.rod_mass = p.crank_inertia_about_com = p.rod_inertia_about_com = 0.0;
  const Mechanism mechanism = test::mechanismOf(p);
  for (double offset = -3.0; offset < 3.0; offset += 0.3) {
    const CrankAngle angle = CrankAngle::fromOffset(offset);
    const ShaftLoad poor = shaftLoad(mechanism, Level::kRocker, angle, kGravity);
    const ShaftLoad rich = shaftLoad(mechanism, Level::kLinkage, angle, kGravity);
    EXPECT_NEAR(rich.inertia, poor.inertia, 1e-15 * 11.0);
    EXPECT_NEAR(rich.half_inertia_slope, poor.half_inertia_slope, 1e-14 * 30.0);
    EXPECT_NEAR(rich.weight_torque, poor.weight_torque, 1e-14 * 140.0);
    EXPECT_NEAR(rich.weight_torque_slope, poor.weight_torque_slope, 1e-14 * 600.0);
  }
}

TEST(ShaftLoad, LevelPulseTurnsLikeTheRocker) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const CrankAngle angle = CrankAngle::fromAngle(5.0);
  EXPECT_EQ(shaftLoad(mechanism, Level::kPulse, angle, kGravity).inertia,
            shaftLoad(mechanism, Level::kRocker, angle, kGravity).inertia);
}

}  // namespace
}  // namespace hammer_loads
