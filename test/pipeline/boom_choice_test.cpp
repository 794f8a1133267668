// When a followed boom is taken as rigid, and when as one on its oil.
#include <gtest/gtest.h>

#include "pipeline/standing_boom.h"

namespace hammer_loads::test {
namespace {

Boom boomWithoutFile() { return std::move(*Boom::make(shippedUrdf()).value); }

TEST(BoomFollower, AutoIsCompliantUntilALongPulseShowsThatRigidSuffices) {
  Follower automatic(BoomModel::kAuto);
  automatic.sample(kLoad);
  EXPECT_TRUE(automatic.sample(kLoad).choice.compliant);
  EXPECT_FALSE(automatic.follower.state().choice.judged);
  const double slowest = 1.0 / automatic.follower.state().frequency[0];

  automatic.follower.turnEnded(pulseOf(100.0 * slowest), 300.0);
  EXPECT_FALSE(automatic.sample(kLoad).choice.compliant);
  EXPECT_TRUE(automatic.follower.state().loads.vibration.isZero(0.0));
  BoomChoice choice = automatic.follower.state().choice;
  EXPECT_TRUE(choice.judged);
  EXPECT_LT(choice.rigid_error, choice.rigid_tolerance);
  EXPECT_EQ(choice.rigid_tolerance, 0.05);
  EXPECT_NEAR(choice.pulse_length, 100.0 * slowest, 1e-9);
  EXPECT_NEAR(choice.lowest_frequency, 1.0 / slowest, 1e-9);

  // What the hammer does: 18 ms.
  automatic.follower.turnEnded(pulseOf(0.018), 300.0);
  choice = automatic.sample(kLoad).choice;
  EXPECT_TRUE(choice.compliant);
  EXPECT_GT(choice.rigid_error, 0.5);
  // The vibration went on meanwhile, as in a boom that is always compliant.
  Follower always(BoomModel::kCompliant);
  for (int i = 0; i < 4; ++i) always.sample(kLoad);
  const JointVector went_on = automatic.follower.state().loads.vibration,
                    went = always.follower.state().loads.vibration;
  EXPECT_LT((went_on - went).norm(), 1e-4 * went.norm()) << "but for levers that the vibration itself changes";
  // A turn without a pulse tells nothing new.
  automatic.follower.turnEnded(std::nullopt, 300.0);
  EXPECT_TRUE(automatic.sample(kLoad).choice.compliant);
}

TEST(BoomFollower, TakesABoomWithoutCylindersAsRigid) {
  Follower automatic(BoomModel::kAuto, boomWithoutFile());
  automatic.sample(kLoad);
  automatic.follower.turnEnded(pulseOf(0.018), 300.0);
  const BoomState& state = automatic.sample(kLoad);
  ASSERT_FALSE(state.fault);
  EXPECT_FALSE(state.choice.compliant);
  EXPECT_FALSE(state.choice.judged);
  EXPECT_FALSE(state.hold_down);
  EXPECT_TRUE(std::isinf(state.reduced.mass));
  EXPECT_EQ(state.frequency.size(), 0);
  Follower rigid(BoomModel::kRigid);
  rigid.sample(kLoad);
  EXPECT_EQ(rigid.follower.state().loads.total, state.loads.total);
}

TEST(BoomFollower, TakesTheBoomAsRigidAtAZeroMomentArm) {
  BoomParameters parameters = shippedBoomParameters();
  // The arm's cylinder, in line with its joint at the working pose.
  CylinderParameters& arm = parameters.cylinders[1];
  arm.base_x = 2.60 - 1.3, arm.base_z = 0.0;
  arm.rod_x = 0.4 * std::cos(1.20), arm.rod_z = 0.4 * std::sin(1.20);
  arm.closed_length = 1.0, arm.stroke = 0.99;
  const Checked<Boom> made = Boom::make(shippedUrdf(), parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  Follower compliant(BoomModel::kCompliant, *made.value);
  compliant.sample(kLoad);
  const BoomState& state = compliant.sample(kLoad);
  ASSERT_FALSE(state.fault);
  EXPECT_TRUE(state.zero_moment_arm);
  EXPECT_FALSE(state.choice.compliant);
  EXPECT_TRUE(state.loads.cylinder[1].zero_moment_arm);
  EXPECT_TRUE(state.loads.total.allFinite());
  Follower rigid(BoomModel::kRigid, *made.value);
  rigid.sample(kLoad);
  EXPECT_EQ(state.loads.total, rigid.follower.state().loads.total);
}

}  // namespace
}  // namespace hammer_loads::test
