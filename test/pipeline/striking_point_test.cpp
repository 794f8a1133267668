// Impulses of ~blow for a striking point off the line D-S, beside a rigid-body impact and the momenta of all links.
#include <gtest/gtest.h>

#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/settings/load.h"
#include "pipeline/shipped_machine.h"
#include "support/held_hull.h"
#include "support/mo100.h"
#include "support/rigid_impact.h"

namespace hammer_loads {
namespace {

struct StrikingCase {
  Level level;
  double offset, friction;
};

void PrintTo(const StrikingCase& c, std::ostream* out) {
  *out << (c.level == Level::kRocker ? "rocker" : "linkage") << ", offset " << c.offset << " m, friction "
       << c.friction;
}

class StrikingPointOfTheNode : public testing::TestWithParam<StrikingCase> {};

/// What the blow says of the speeds counts; the impulses and the energy are worked out anew.
TEST_P(StrikingPointOfTheNode, GivesTheImpulsesOfARigidBodyImpact) {
  Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  HammerParameters p = settings.mechanism.parameters();
  p.striking_offset = GetParam().offset, p.striking_friction = GetParam().friction;
  p.rod_std = {};
  settings.mechanism = test::mechanismOf(p);
  settings.pipeline.level = GetParam().level;
  const bool massless = GetParam().level == Level::kRocker;
  const simulation::MachineSettings machine = test::shippedMachine(settings, 6.0, 75);
  const simulation::Session session = simulation::recordSession(machine);
  Pipeline pipeline(settings.mechanism, settings.pipeline, {});
  StrikingRocker rocker;
  rocker.mass = p.rocker_mass, rocker.inertia_about_pivot = p.rocker_inertia_about_pivot;
  rocker.com = {-p.rocker_com_distance, 0.0};
  rocker.rod_joint = {-p.lengths.rocker * std::cos(p.rocker_com_angle),
                      -p.lengths.rocker * std::sin(p.rocker_com_angle)};
  const double rod_about_b =
      p.rod_inertia_about_com + p.rod_mass * (p.rod_com_along * p.rod_com_along + p.rod_com_across * p.rod_com_across);
  rocker.reduced_rod_mass = massless ? 0.0 : rod_about_b / (p.lengths.rod * p.lengths.rod);
  rocker.striking_point = {-p.striking_distance, p.striking_offset};
  rocker.friction = p.striking_friction;
  const double u_before = test::transferAtBlow(p, false), u_after = test::transferAtBlow(p, true);
  int seen = 0;
  for (const simulation::CrankReading& reading : session.crank) {
    const SampleResult& result = pipeline.crankSample(reading.stamp, {reading.angle, reading.speed});
    for (std::size_t k = 0; k < result.turn_ends; ++k) {
      const RockerBlow& blow = result.ends[k].blow;
      if (blow.impossible || !(blow.restitution > 0.0)) continue;
      ++seen;
      EXPECT_NEAR(blow.rocker_speed_before, u_before * blow.crank_speed_before, 1e-10 * std::abs(u_before) * 20.0);
      const test::RigidImpact truth =
          test::ImpactingRocker(rocker).strike(blow.rocker_speed_before, blow.rocker_speed_after);
      ASSERT_FALSE(truth.sticks);
      const double size = truth.tool.norm();
      EXPECT_NEAR(blow.tool_impulse_x, truth.tool.x(), 1e-10 * size);
      EXPECT_NEAR(blow.tool_impulse_z, truth.tool.y(), 1e-10 * size);
      EXPECT_NEAR(blow.energy, truth.energy, 1e-10 * truth.energy);
      // The hull gets what the tool gives less what all links take up, until the linkage holds them again.
      const Eigen::Vector3d change =
          test::momentumAtBlow(p, blow.crank_speed_after, u_after * blow.crank_speed_after, massless) -
          test::momentumAtBlow(p, blow.crank_speed_before, u_before * blow.crank_speed_before, massless);
      const double tool_moment = p.striking_offset * truth.tool.x() + p.striking_distance * truth.tool.y();
      EXPECT_NEAR(blow.support_impulse_x, truth.tool.x() - change[0], 1e-10 * size);
      EXPECT_NEAR(blow.support_impulse_z, truth.tool.y() - change[1], 1e-10 * size);
      EXPECT_NEAR(blow.support_impulse_y, tool_moment - change[2], 1e-10 * size);
    }
  }
  EXPECT_GE(seen, 12);
}

INSTANTIATE_TEST_SUITE_P(
    Pipeline, StrikingPointOfTheNode,
    testing::Values(StrikingCase{Level::kRocker, 0.0, 0.4}, StrikingCase{Level::kRocker, 0.02, 0.25},
                    StrikingCase{Level::kRocker, -0.02, 0.25}, StrikingCase{Level::kLinkage, 0.015, 0.4},
                    StrikingCase{Level::kLinkage, -0.03, 0.4}, StrikingCase{Level::kLinkage, 0.02, 0.0}));

}  // namespace
}  // namespace hammer_loads
