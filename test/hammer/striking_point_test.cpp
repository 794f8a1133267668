// Blow at a striking point off the line D-S with friction, compared with a rigid-body impact with Coulomb friction.
#include <gtest/gtest.h>

#include "hammer_loads/hammer/blow.h"
#include "support/mo100.h"
#include "support/rigid_impact.h"

namespace hammer_loads {
namespace {

void expectEqual(const RockerBlow& blow, const test::RigidImpact& truth, double energy) {
  const double size = truth.tool.norm() + truth.hull.norm();
  EXPECT_NEAR(blow.tool_impulse_x, truth.tool.x(), 1e-10 * size);
  EXPECT_NEAR(blow.tool_impulse_z, truth.tool.y(), 1e-10 * size);
  EXPECT_NEAR(blow.support_impulse_x, truth.hull.x(), 1e-10 * size);
  EXPECT_NEAR(blow.support_impulse_z, truth.hull.y(), 1e-10 * size);
  EXPECT_NEAR(blow.energy, truth.energy, 1e-10 * energy);
  EXPECT_NEAR(blow.friction_work, truth.friction_work, 1e-10 * energy);
}

TEST(StrikingPoint, GivesTheImpulsesOfARigidBodyImpactForAnyRocker) {
  std::mt19937 random(75);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  int slid = 0;
  for (int i = 0; i < 1000; ++i) {
    const double before = (i % 2 ? -1.0 : 1.0) * between(5.0, 80.0);
    const double after = i % 5 == 0 ? 0.0 : -between(0.0, 0.6) * before;
    StrikingRocker r;
    r.mass = between(1.0, 50.0);
    r.com = {between(-0.2, 0.2), between(-0.2, 0.2)};
    r.inertia_about_pivot = r.mass * (r.com.x * r.com.x + r.com.z * r.com.z) + between(0.05, 1.0);
    r.rod_joint = {between(-0.2, 0.2), between(-0.2, 0.2)};
    r.reduced_rod_mass = i % 3 ? between(0.1, 10.0) : 0.0;
    r.striking_point = {(before < 0.0 ? -1.0 : 1.0) * between(0.1, 0.4), i % 7 == 0 ? 0.0 : between(-0.09, 0.09)};
    r.friction = between(0.0, 0.8);
    const test::RigidImpact truth = test::ImpactingRocker(r).strike(before, after);
    ASSERT_FALSE(truth.sticks);
    expectEqual(blowInSupport(r, before, after), truth, 0.5 * r.inertia_about_pivot * before * before);
    slid += std::abs(truth.tool.x()) > 0.01 * truth.tool.y();
  }
  EXPECT_GT(slid, 500);
}

/// The rocker sticks to the tool exactly for the parameters that Mechanism::make() refuses.
TEST(StrikingPoint, SticksWhereTheMechanismIsRefused) {
  for (const double side : {-1.0, 1.0}) {
    for (const double part : {0.5, 0.999, 1.001, 1.5}) {
      HammerParameters p = test::mo100Parameters();
      p.striking_friction = 1.5;
      p.striking_offset = side * part * p.striking_distance / 1.5;
      StrikingRocker r = strikingRocker(test::mechanismOf(test::mo100Parameters()), Level::kRocker);
      r.striking_point.z = p.striking_offset;
      r.friction = p.striking_friction;
      const test::RigidImpact truth = test::ImpactingRocker(r).strike(-50.0, 8.0);
      const Checked<Mechanism> mechanism = Mechanism::make(p);
      EXPECT_EQ(truth.sticks, part > 1.0) << part;
      EXPECT_EQ(mechanism.value.has_value(), part < 1.0) << part;
      if (mechanism.value) {
        expectEqual(blowInSupport(strikingRocker(*mechanism.value, Level::kRocker), -50.0, 8.0), truth, 921.0);
      } else {
        ASSERT_EQ(mechanism.problems.size(), 1U);
        EXPECT_EQ(mechanism.problems[0].rfind("striking_offset_m: ", 0), 0U) << mechanism.problems[0];
      }
    }
  }
}

}  // namespace
}  // namespace hammer_loads
