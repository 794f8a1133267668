/// Reaction of the drive compared with the angular momentum of a geared rotor.
#include <gtest/gtest.h>

#include "hammer_loads/linkage/mechanism.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

Mechanism hammerWith(double ratio) {
  HammerParameters p = test::mo100LinkageParameters();
  p.drive_reaction_ratio = ratio;
  return *Mechanism::make(p).value;
}

TEST(DriveReaction, IsTheRotorsChangeOfAngularMomentum) {
  constexpr double kRotor = 0.02, kAcceleration = -1500.0, kHull = 40.0;
  for (const double gear : {1.0, 5.0, -3.0}) {
    // The rotor turns at gear x crank relative to the hull and shares the hull's rotation.
    const double rate = kRotor * (gear * kAcceleration + kHull);
    const DriveReaction reaction = driveReaction(hammerWith(1.0 / gear), Level::kLinkage, gear * gear * kRotor);
    EXPECT_NEAR(reaction.torque(kAcceleration, kHull), -rate, 1e-12 * std::abs(rate)) << gear;
  }
}

TEST(DriveReaction, HasTheCranksInertiaAtOneForALevelThatCountsItAsDrive) {
  const HammerParameters p = test::mo100LinkageParameters();
  const double crank = p.crank_inertia_about_com +
                       p.crank_mass * (p.crank_com_along * p.crank_com_along + p.crank_com_across * p.crank_com_across);
  const DriveReaction reaction = driveReaction(hammerWith(0.25), Level::kRocker, 0.6);
  EXPECT_NEAR(reaction.by_crank, 0.25 * (0.6 - crank) + crank, 1e-15);
  EXPECT_NEAR(reaction.by_hull, 0.0625 * (0.6 - crank) + crank, 1e-15);
}

}  // namespace
}  // namespace hammer_loads
