#include "hammer_loads/pipeline/boom_follower.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hammer_loads/pipeline/boom_warnings.h"
#include "pipeline/standing_boom.h"

namespace hammer_loads::test {
namespace {

/// A load that is no number, in one step: the vibration begins anew, its loads are withheld until what was wrong would
/// have died out, and are then those of a follower that knew nothing of it.
TEST(BoomFollower, ResetsAVibrationThatRunsAwayAndWithholdsItForAWhile) {
  Follower struck(BoomModel::kCompliant), other(BoomModel::kCompliant);
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(struck.sample(kLoad).fault) << "the channel";
  EXPECT_EQ(struck.follower.runaways(), 0U);
  const BoomState& first = struck.sample({kNaN, kNaN, kNaN});
  ASSERT_TRUE(first.fault);
  EXPECT_EQ(first.fault->kind, JointFault::Kind::kRunAway);
  EXPECT_EQ(struck.follower.runaways(), 1U);
  int withheld = 1;
  while (struck.sample(kLoad).fault) {
    ASSERT_EQ(struck.follower.state().fault->kind, JointFault::Kind::kRunAway);
    ASSERT_LT(++withheld, 10001);
  }
  EXPECT_GT(withheld, 50) << "a boom swings for some periods";
  EXPECT_EQ(struck.follower.runaways(), 1U);
  for (int i = 0; i < 10000; ++i) struck.sample(kLoad), other.sample(kLoad);
  const JointVector torque = struck.follower.state().loads.total;
  ASSERT_TRUE(torque.allFinite());
  EXPECT_NEAR((torque - other.follower.state().loads.total).norm(), 0.0, 1e-3 * torque.norm());
}

TEST(BoomFollower, RigidLoadsAreThoseOfTheInterpolatedPose) {
  Follower rigid(BoomModel::kRigid);
  rigid.follower.jointStates(0, kFour, {0.2, -0.36, 1.18, -0.85}, {0.0, 0.2, 0.3, -0.2});
  rigid.follower.jointStates(20 * kMs, kFour, {0.2, -0.32, 1.22, -0.87}, {0.0, 0.4, 0.1, -0.1});
  const BoomState& state = rigid.follower.sample({5 * kMs, kLoad}, {});
  ASSERT_FALSE(state.fault);
  EXPECT_EQ(state.stamp, 5 * kMs);

  Boom boom = shippedBoom();
  boom.move({joints({0.2, -0.35, 1.19, -0.855}), joints({0.0, 0.25, 0.25, -0.175}), joints({0.0, 10.0, -10.0, 5.0})},
            {0.0, 0.0, -kGravity});
  BoomLoads expected;
  boom.loads({{kLoad.force_x, 0.0, kLoad.force_z}, {0.0, kLoad.torque_y, 0.0}}, true, expected);
  EXPECT_TRUE(state.loads.hammer.isApprox(expected.hammer, 1e-14));
  EXPECT_TRUE(state.loads.weight.isApprox(expected.weight, 1e-14));
  EXPECT_TRUE(state.loads.motion.isApprox(expected.motion, 1e-12));
  EXPECT_TRUE(state.loads.vibration.isZero(0.0));
  EXPECT_NEAR(state.loads.cylinder[0].force / expected.cylinder[0].force, 1.0, 1e-12);
  const double pitch = -0.35 + 1.19 - 0.855;
  EXPECT_NEAR(rigid.follower.boom().gravityAtTip().x(), kGravity * std::sin(pitch), 1e-14 * kGravity);
  EXPECT_NEAR(rigid.follower.boom().gravityAtTip().z(), -kGravity * std::cos(pitch), 1e-14 * kGravity);
  EXPECT_FALSE(state.choice.compliant);
}

TEST(BoomFollower, ALoadThatStaysIsCarriedAsOnARigidBoom) {
  Follower rigid(BoomModel::kRigid), compliant(BoomModel::kCompliant);
  rigid.sample(kLoad);
  for (int i = 0; i < 20000; ++i) compliant.sample(kLoad);
  const BoomState& state = compliant.follower.state();
  EXPECT_TRUE(state.choice.compliant);
  // exp(-zeta omega t) of what began: below 1e-7 after 20 s at 0.05 and some 3 Hz.
  EXPECT_TRUE(state.loads.total.isApprox(rigid.follower.state().loads.total, 1e-7));
  EXPECT_TRUE(state.tip.velocity.isZero(1e-6));
  const double deflection = state.tip.displacement.z();
  EXPECT_GT(deflection, 0.0);
  // Along z alone the hull yields as its reduced stiffness says; the x force and moment are a tenth of it here.
  EXPECT_NEAR(deflection, kLoad.force_z / state.reduced.stiffness, 0.5 * deflection);
}

TEST(BoomFollower, AShortStepGivesItsMeanAsMomentumToTheReducedMass) {
  Follower compliant(BoomModel::kCompliant);
  compliant.sample({});
  WrenchHistory step = steadyStep(1e-5, {});
  step.pieces[0].mean.force_z = 8000.0;  // a bump: nothing at the ends
  const BoomState& state = compliant.sample({}, step);
  const double speed = 8000.0 * 1e-5 / state.reduced.mass;
  // Within the step the boom hardly moves: (omega h)^2 and zeta omega h are below 2e-3.
  EXPECT_NEAR(state.tip.velocity.z(), speed, 2e-3 * speed);
}

TEST(BoomFollower, ABlowBetweenPiecesIsAnImpulse) {
  Follower compliant(BoomModel::kCompliant);
  compliant.sample({});
  WrenchHistory step;
  step.count = 2;
  step.pieces[0].duration = step.pieces[1].duration = 1e-9;
  step.pieces[0].ends_in_blow = true;
  step.pieces[0].blow.force_z = 60.0;
  const BoomState& state = compliant.sample({}, step);
  EXPECT_NEAR(state.tip.velocity.z(), 60.0 / state.reduced.mass, 1e-6 * 60.0 / state.reduced.mass);
  // The energy is that of the reduced mass.
  EXPECT_NEAR(compliant.follower.boom().vibration().energy(), 0.5 * 60.0 * 60.0 / state.reduced.mass, 1e-3);
}

TEST(BoomFollower, RestsAfterAGap) {
  Follower compliant(BoomModel::kCompliant);
  compliant.sample(kLoad);
  compliant.sample(kLoad);
  ASSERT_GT(compliant.follower.state().tip.velocity.norm(), 1e-4);
  compliant.sample(kLoad, {});
  EXPECT_TRUE(compliant.follower.state().tip.velocity.isZero(0.0));
  EXPECT_TRUE(compliant.follower.state().loads.vibration.isZero(0.0));
  compliant.sample(kLoad);
  EXPECT_GT(compliant.follower.state().tip.velocity.norm(), 1e-4);
}

/// As on a computer that is behind: the state is there when the reason is asked for, and was not at the sample.
TEST(BoomFollower, NamesJointStatesThatComeLaterThanTheSample) {
  Follower compliant(BoomModel::kCompliant);
  compliant.sample(kLoad);
  compliant.now += 300 * kMs;
  ASSERT_TRUE(compliant.follower.sample({compliant.now, kLoad}, {}).fault);
  compliant.follower.jointStates(compliant.now, kFour, {0.2, -0.35, 1.2, -0.85}, {});
  ASSERT_TRUE(compliant.follower.joints().complaints(compliant.now).empty());
  std::vector<Warning> warnings;
  warnOfBoom(compliant.follower, &compliant.follower.state(), false, warnings);
  const auto joints = std::find_if(warnings.begin(), warnings.end(),
                                   [](const Warning& w) { return std::string(w.key) == "boom joints"; });
  ASSERT_NE(joints, warnings.end());
  EXPECT_EQ(
      joints->text,
      "boom joints: no loads for 1 samples: swing_joint: its states come later than the crank samples of their time");
}

TEST(BoomFollower, NamesTheJointThatIsNotKnownAndGoesOnWhenItIs) {
  Follower compliant(BoomModel::kCompliant);
  EXPECT_TRUE(compliant.follower.sample({0, kLoad}, {}).fault);
  compliant.sample(kLoad);
  ASSERT_FALSE(compliant.sample(kLoad).fault);
  compliant.now += 100 * kMs;
  compliant.follower.jointStates(compliant.now, {"swing_joint", "boom_joint", "hammer_joint"}, {0.2, -0.35, -0.85}, {});
  compliant.now += 150 * kMs;
  const BoomState& state = compliant.follower.sample({compliant.now, kLoad}, steadyStep(1e-3, kLoad));
  ASSERT_TRUE(state.fault);
  EXPECT_EQ(state.fault->kind, JointFault::Kind::kStale);
  EXPECT_EQ(compliant.follower.joints().name(state.fault->joint), "arm_joint");
  EXPECT_EQ(compliant.follower.faults(), 2U);
  // The step that ends at the first good sample is not known as a whole.
  ASSERT_FALSE(compliant.sample(kLoad).fault);
  EXPECT_TRUE(compliant.follower.state().tip.velocity.isZero(0.0));
}

TEST(BoomFollower, StatesTheHullsLoadAtALink) {
  Follower rigid(BoomModel::kRigid);
  rigid.follower.jointStates(0, kFour, {0.0, 0.0, 0.4, 0.0}, {});
  rigid.follower.sample({0, {}}, {});
  const auto arm = rigid.follower.linkIndex("arm_link");
  ASSERT_TRUE(arm);
  EXPECT_FALSE(rigid.follower.linkIndex("strain_gauge"));
  // The hull stands 1.80 m ahead of the arm's pin and 0.55 m below it.
  const Wrench w = rigid.follower.wrenchAtLink(*arm, {1000.0, 20000.0, 50.0});
  EXPECT_NEAR(w.force.x(), 1000.0, 1e-9);
  EXPECT_NEAR(w.force.z(), 20000.0, 1e-9);
  EXPECT_NEAR(w.torque.y(), 50.0 - 0.55 * 1000.0 - 1.80 * 20000.0, 1e-9);
}

TEST(BoomFollower, HoldsDownAgainstTheMeanHoldDownForceAtTheTool) {
  Follower rigid(BoomModel::kRigid);
  rigid.follower.turnEnded(std::nullopt, 3000.0);
  EXPECT_FALSE(rigid.sample({}).hold_down) << "before any sample nothing is known";
  rigid.follower.turnEnded(std::nullopt, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(rigid.follower.state().hold_down);
  EXPECT_EQ(rigid.follower.firstToGive(), "");
  rigid.follower.turnEnded(std::nullopt, 3000.0);
  ASSERT_TRUE(rigid.follower.state().hold_down);
  const HoldDown once = *rigid.follower.state().hold_down;
  EXPECT_EQ(rigid.follower.firstToGive(), "boom_cylinder");
  EXPECT_EQ(once.least, once.cylinder[0]);
  EXPECT_TRUE(once.holds());

  // The same force at the tool's end, moments about the rear edge by hand: all masses against the force.
  const Boom& boom = rigid.follower.boom();
  const hammer_loads::Pose& X_BH = boom.pose().tip();
  const Eigen::Vector3d tool = X_BH * Eigen::Vector3d(-kStrikingDistance, 0.0, -0.75);
  const Eigen::Vector3d force = 3000.0 * X_BH.linear().col(2);
  const double rear = boom.parameters().supports->rear_x;
  double weight = 0.0;
  for (int i = 0; i < boom.chain().links(); ++i) {
    const PointMass& body = boom.chain().link(i).body;
    weight += body.mass * kGravity * ((boom.pose().link(i) * body.p).x() - rear);
  }
  EXPECT_EQ(once.edge, 2);
  EXPECT_NEAR(once.machine, weight / (force.z() * (tool.x() - rear) - force.x() * tool.z()), 1e-9);
  rigid.follower.turnEnded(std::nullopt, 6000.0);
  EXPECT_NEAR(rigid.follower.state().hold_down->machine, 0.5 * once.machine, 1e-12);

  // Without cylinders only the machine's weight is left.
  BoomParameters parameters = boom.parameters();
  parameters.cylinders.clear();
  Follower bare(BoomModel::kRigid, *Boom::make(shippedUrdf(), parameters).value);
  bare.sample({});
  bare.follower.turnEnded(std::nullopt, 3000.0);
  EXPECT_EQ(bare.follower.firstToGive(), "rear edge");
}

}  // namespace
}  // namespace hammer_loads::test
