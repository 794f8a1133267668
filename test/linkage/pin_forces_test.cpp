#include "hammer_loads/linkage/pin_forces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

const NearBlow kNearBlow(0.01);

constexpr PinForce PinReactions::*kPins[] = {&PinReactions::hull_on_crank, &PinReactions::crank_on_rod,
                                             &PinReactions::rod_on_rocker, &PinReactions::hull_on_rocker};

TEST(PinForces, AreFiniteAndContinuousAtTheBlowOfAnUnacceleratedCrank) {
  HammerParameters p = test::mo100LinkageParameters();
  p.rod_com_across = 0.0;  // a centre of mass off the rod's line requires an unbounded force, too
  const Mechanism mechanism = test::mechanismOf(p);
  for (Level level : {Level::kRocker, Level::kLinkage}) {
    for (Side side : {Side::kBeforeBlow, Side::kAfterBlow}) {
      const double step = side == Side::kBeforeBlow ? -1e-9 : 1e-9;
      const PinReactions at = pinForces(mechanism, level, {{0.0, side}, 31.0, 0.0}, {}, kNearBlow);
      const PinReactions by = pinForces(mechanism, level, {{step, side}, 31.0, 0.0}, {}, kNearBlow);
      for (const auto pin : kPins) {
        const PinForce& a = at.*pin;
        const PinForce& b = by.*pin;
        ASSERT_TRUE(std::isfinite(a.x) && std::isfinite(a.z));
        const double size = std::hypot(a.x, a.z);
        EXPECT_GT(size, 100.0);
        EXPECT_NEAR(a.x, b.x, 1e-6 * size);
        EXPECT_NEAR(a.z, b.z, 1e-6 * size);
      }
      EXPECT_TRUE(at.near_blow);
    }
  }
}

bool anyIsNaN(const PinReactions& pins) {
  return std::any_of(std::begin(kPins), std::end(kPins),
                     [&](const auto pin) { return std::isnan((pins.*pin).x) || std::isnan((pins.*pin).z); });
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
    // Doubles do not distinguish these offsets from the blow: 2 pi less 4e-16 is 2 pi.
    ASSERT_EQ(kTwoPi - 4e-16, kTwoPi);
    for (const double offset : {0.0, 1e-300, 1e-18, 4e-16}) {
      EXPECT_TRUE(anyIsNaN(at(offset))) << offset;
      EXPECT_NEAR(at(offset).drive_torque, at(1e-12).drive_torque, 1e-6 * std::abs(at(1e-12).drive_torque));
    }
  }
}

/// The hull's angular acceleration and the weight drive the rocker as the crank's acceleration does.
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

/// A crank 5e-4 rad from the blow may be at the blow, if its angle is known to 1e-3 rad. 1/s has no value there.
TEST(PinForces, AreNoNumberWithinTheAnglesErrorOfTheBlow) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  for (const double offset : {-2e-3, -5e-4, 5e-4, 2e-3}) {
    const CrankMotion crank{CrankAngle::fromOffset(offset), 31.0, 500.0};
    EXPECT_FALSE(anyIsNaN(pinForces(mechanism, Level::kLinkage, crank, {}, NearBlow(0.01)))) << offset;
    EXPECT_EQ(anyIsNaN(pinForces(mechanism, Level::kLinkage, crank, {}, NearBlow(0.01).withAngleError(1e-3))),
              std::abs(offset) < 1e-3)
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

}  // namespace
}  // namespace hammer_loads
