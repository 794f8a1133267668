#include "hammer_loads/linkage/pin_forces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "support/csv.h"
#include "support/mo100.h"
#include "support/newton_euler.h"

namespace hammer_loads {
namespace {

using test::Real;

const NearBlow kNearBlow(0.01);

struct Named {
  const char* name;
  PinForce PinReactions::*pin;
  test::Vector test::Reference::*exact;
};
const Named kPins[] = {{"R01", &PinReactions::hull_on_crank, &test::Reference::r01},
                       {"R12", &PinReactions::crank_on_rod, &test::Reference::r12},
                       {"R23", &PinReactions::rod_on_rocker, &test::Reference::r23},
                       {"R03", &PinReactions::hull_on_rocker, &test::Reference::r03}};

double relativeError(const PinForce& force, const test::Vector& exact) {
  const test::Vector miss{Real(force.x) - exact.x, Real(force.z) - exact.y};
  return static_cast<double>(sqrt(dot(miss, miss) / dot(exact, exact)));
}

Gravity gravityOf(const test::Csv& csv, std::size_t row) {
  const double g = csv.number(row, "gravity_m_s2"), pitch = csv.number(row, "hull_pitch_rad");
  return {g * std::sin(pitch), -g * std::cos(pitch)};
}

TEST(PinForces, EqualTheReferenceTables) {
  for (const auto& [name, level] :
       {std::pair{"mo100_constant_speed.csv", Level::kRocker}, std::pair{"mo100_linkage.csv", Level::kLinkage}}) {
    const test::Csv csv = test::dataCsv(name);
    const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
    std::size_t rows = 0;
    for (std::size_t i = 0; i < csv.size(); ++i) {
      const CrankAngle angle = CrankAngle::fromAngle(csv.number(i, "crank_angle_rad"));
      // Where the forces grow as 1/offset, an angle near 2 pi as double moves them by 4.4e-16/offset.
      const double rounding =
          angle.side == Side::kBeforeBlow && level == Level::kLinkage ? 4.5e-16 / -angle.offset : 0.0;
      const CrankMotion crank{angle, csv.number(i, "crank_speed_rad_s"), csv.number(i, "crank_accel_rad_s2")};
      const PinReactions pins = pinForces(mechanism, level, crank, gravityOf(csv, i), kNearBlow);
      for (const Named& named : kPins) {
        const PinForce& pin = pins.*named.pin;
        const std::string column = named.name;
        const double x = csv.number(i, column + "_x_N"), z = csv.number(i, column + "_z_N");
        EXPECT_NEAR(pin.x, x, 1e-12 * csv.peak(column + "_x_N") + rounding * std::abs(x)) << name << ' ' << i << column;
        EXPECT_NEAR(pin.z, z, 1e-12 * csv.peak(column + "_z_N") + rounding * std::abs(z)) << name << ' ' << i << column;
      }
      EXPECT_NEAR(pins.drive_torque, csv.number(i, "drive_torque_y_Nm"), 1e-12 * csv.peak("drive_torque_y_Nm"));
      ++rows;
    }
    EXPECT_EQ(rows, csv.size());
  }
}

TEST(PinForces, KeepAllDigitsNearTheBlowForAnyMachine) {
  std::mt19937 random(31);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    double worst = 0.0;
    for (int i = 0; i < 6; ++i) {
      const HammerParameters p = i == 0 ? test::mo100LinkageParameters() : test::randomParameters(random);
      const Mechanism mechanism = test::mechanismOf(p);
      const test::NewtonEuler exact(p, level);
      for (int decade = 1; decade <= 12; ++decade) {
        for (double offset : {-1.7 * std::pow(10.0, -decade), 1.7 * std::pow(10.0, -decade)}) {
          for (const auto& [e, gravity] : {std::pair{0.0, Gravity{}}, std::pair{-700.0, Gravity{2.0, -9.5}}}) {
            const CrankMotion crank{CrankAngle::fromOffset(offset), 30.0, e};
            const PinReactions pins = pinForces(mechanism, level, crank, gravity, kNearBlow);
            const test::Reference reference = exact.at(crank.angle, crank.speed, e, gravity);
            for (const Named& named : kPins)
              worst = std::max(worst, relativeError(pins.*named.pin, reference.*named.exact));
          }
        }
      }
    }
    EXPECT_LE(worst, 1e-13) << static_cast<int>(level);
    std::printf("worst relative error of pin forces near the blow, level %d: %.2e\n", static_cast<int>(level), worst);
  }
}

TEST(PinForces, AreFiniteAndContinuousAtTheBlowOfAnUnacceleratedCrank) {
  HammerParameters p = test::mo100LinkageParameters();
  p.rod_com_across = 0.0;  // off its line the rod's mass needs an unbounded force, too
  const Mechanism mechanism = test::mechanismOf(p);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (Side side : {Side::kBeforeBlow, Side::kAfterBlow}) {
      const double step = side == Side::kBeforeBlow ? -1e-9 : 1e-9;
      const PinReactions at = pinForces(mechanism, level, {{0.0, side}, 31.0, 0.0}, {}, kNearBlow);
      const PinReactions by = pinForces(mechanism, level, {{step, side}, 31.0, 0.0}, {}, kNearBlow);
      for (const Named& named : kPins) {
        const PinForce& a = at.*named.pin;
        const PinForce& b = by.*named.pin;
        ASSERT_TRUE(std::isfinite(a.x) && std::isfinite(a.z)) << named.name;
        const double size = std::hypot(a.x, a.z);
        EXPECT_GT(size, 100.0);
        EXPECT_NEAR(a.x, b.x, 1e-6 * size) << named.name;
        EXPECT_NEAR(a.z, b.z, 1e-6 * size) << named.name;
      }
      EXPECT_TRUE(at.near_blow);
    }
  }
}

bool anyIsNaN(const PinReactions& pins) {
  return std::any_of(std::begin(kPins), std::end(kPins), [&](const Named& named) {
    return std::isnan((pins.*named.pin).x) || std::isnan((pins.*named.pin).z);
  });
}

TEST(PinForces, GrowUnboundedTowardsTheBlowOfAnAcceleratedCrankAndAreNoNumberAtIt) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    const auto at = [&](double offset) {
      const PinReactions pins = pinForces(mechanism, level, {{offset, Side::kAfterBlow}, 31.0, 500.0}, {}, kNearBlow);
      EXPECT_TRUE(pins.near_blow);
      EXPECT_TRUE(std::isfinite(pins.drive_torque));
      return pins;
    };
    const auto size = [&](double offset) {
      const PinReactions pins = at(offset);
      EXPECT_FALSE(anyIsNaN(pins)) << offset;
      return std::hypot(pins.rod_on_rocker.x, pins.rod_on_rocker.z);
    };
    EXPECT_NEAR(size(1e-6) / size(1e-5), 10.0, 0.01);
    EXPECT_NEAR(size(1e-12) / size(1e-11), 10.0, 1e-6);
    // Two angles of a turn that no double tells apart: 2 pi less 4e-16 is 2 pi.
    ASSERT_EQ(kTwoPi - 4e-16, kTwoPi);
    for (const double offset : {0.0, 1e-300, 1e-18, 4e-16}) {
      EXPECT_TRUE(anyIsNaN(at(offset))) << offset;
      EXPECT_NEAR(at(offset).drive_torque, at(1e-12).drive_torque, 1e-6 * std::abs(at(1e-12).drive_torque));
    }
  }
}

/// The hull's own turning and its weight drive the rocker as the crank's acceleration does.
TEST(PinForces, HaveNoLimitAtTheBlowWhateverTurnsTheRocker) {
  HammerParameters p = test::mo100LinkageParameters();
  p.rod_com_across = 0.0;
  const Mechanism mechanism = test::mechanismOf(p);
  const HullMotion still, heavy{{0.0, -9.8}, 0.0, 0.0}, turning{{0.0, 0.0}, 0.0, 2.0};
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    const CrankMotion crank{{0.0, Side::kBeforeBlow}, 31.0, 0.0};
    EXPECT_FALSE(anyIsNaN(pinForces(mechanism, level, crank, still, kNearBlow)));
    EXPECT_TRUE(anyIsNaN(pinForces(mechanism, level, crank, heavy, kNearBlow)));
    EXPECT_TRUE(anyIsNaN(pinForces(mechanism, level, crank, turning, kNearBlow)));
  }
}

/// A crank whose angle is known to 1e-3 rad may as well stand at the blow 5e-4 rad beside it, where 1/s has no value.
TEST(PinForces, AreNoNumberWithinTheAnglesErrorOfTheBlow) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (const double offset : {-2e-3, -5e-4, 5e-4, 2e-3}) {
    const CrankMotion crank{CrankAngle::fromOffset(offset), 31.0, 500.0};
    EXPECT_FALSE(anyIsNaN(pinForces(mechanism, Level::kLinkage, crank, {}, NearBlow(0.01)))) << offset;
    EXPECT_EQ(anyIsNaN(pinForces(mechanism, Level::kLinkage, crank, {}, NearBlow(0.01, 1e-3))), std::abs(offset) < 1e-3)
        << offset;
  }
}

TEST(PinForces, FlagFollowsTheTransmissionAngle) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  for (double offset = -1.5; offset <= 1.5; offset += 0.01) {
    const LinkMotion l = linkMotion(mechanism.linkage(), CrankAngle::fromOffset(offset));
    EXPECT_EQ(NearBlow(0.1)(l), transmissionAngle(l) < 0.1) << offset;
    EXPECT_NEAR(transmissionAngle(l), rockerAngle(l.rocker) - rodAngle(l), 1e-14);
  }
}

TEST(PinForces, MasslessCrankAndRodCarryOneForceAlongTheRod) {
  const Mechanism mechanism = test::mechanismOf(test::mo100Parameters());
  for (double phi = 0.05; phi < 6.2; phi += 0.1) {
    const CrankMotion crank{CrankAngle::fromAngle(phi), 25.0, 100.0};
    const PinReactions pins = pinForces(mechanism, Level::kRocker, crank, {1.0, -9.0}, kNearBlow);
    EXPECT_EQ(pins.crank_on_rod.x, pins.rod_on_rocker.x);
    EXPECT_EQ(pins.hull_on_crank.z, pins.rod_on_rocker.z);
    const LinkMotion l = linkMotion(mechanism.linkage(), crank.angle);
    const double c = mechanism.cosComAngle(), s = mechanism.sinComAngle();
    const double rod_x = -(c * l.beta.re + s * l.beta.im), rod_z = -s * l.beta.re + c * l.beta.im;
    const double size = std::hypot(pins.rod_on_rocker.x, pins.rod_on_rocker.z);
    EXPECT_NEAR(pins.rod_on_rocker.x * rod_z - pins.rod_on_rocker.z * rod_x, 0.0, 1e-14 * size);
  }
}

TEST(PinForces, MasslessCrankAndRodLeaveTheRockersForces) {
  HammerParameters p = test::mo100LinkageParameters();
  p.crank_mass = p.rod_mass = p.crank_inertia_about_com = p.rod_inertia_about_com = 0.0;
  const Mechanism mechanism = test::mechanismOf(p);
  for (double phi = 0.05; phi < 6.2; phi += 0.1) {
    const CrankMotion crank{CrankAngle::fromAngle(phi), -25.0, 900.0};
    const PinReactions poor = pinForces(mechanism, Level::kRocker, crank, {1.0, -9.0}, kNearBlow);
    const PinReactions rich = pinForces(mechanism, Level::kLinkage, crank, {1.0, -9.0}, kNearBlow);
    for (const Named& named : kPins) {
      EXPECT_NEAR((rich.*named.pin).x, (poor.*named.pin).x, 1e-14 * 1e6) << named.name;
      EXPECT_NEAR((rich.*named.pin).z, (poor.*named.pin).z, 1e-14 * 1e6) << named.name;
    }
    EXPECT_NEAR(rich.drive_torque, poor.drive_torque, 1e-14 * 1e5);
  }
}

}  // namespace
}  // namespace hammer_loads
