#include "hammer_loads/pipeline/joint_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "boom/booms.h"
#include "hammer_loads/util/constants.h"
#include "support/constants.h"

namespace hammer_loads {
namespace {

using test::kMs;
using Names = std::vector<std::string>;

PipelineSettings accelerated() {
  PipelineSettings s;
  s.joint_max_age = 0.2;
  s.boom_acceleration = BoomAcceleration::kDifference;
  return s;
}

using test::kFour;

class Joints : public testing::Test {
 protected:
  /// Returns the motion at a stamp, which must be known.
  JointMotion at(StampNs stamp) const {
    JointMotion motion;
    const auto fault = buffer_.at(stamp, motion);
    EXPECT_FALSE(fault) << (fault ? buffer_.name(fault->joint) : "");
    return motion;
  }
  Boom boom_{test::shippedBoom()};
  JointBuffer buffer_{boom_.chain(), accelerated()};
};

TEST_F(Joints, AreHeldBeyondTheNewestStateAndLinearBetweenStates) {
  ASSERT_TRUE(buffer_.update(1000 * kMs, kFour, {0.1, -0.4, 1.2, -0.8}, {0.0, 0.1, 0.2, 0.3}));
  ASSERT_TRUE(buffer_.update(1020 * kMs, kFour, {0.1, -0.3, 1.3, -0.9}, {0.0, 0.5, 0.4, 0.1}));
  const JointMotion held = at(1100 * kMs);
  EXPECT_EQ(held.position, test::joints({0.1, -0.3, 1.3, -0.9}));
  EXPECT_EQ(held.velocity, test::joints({0.0, 0.5, 0.4, 0.1}));
  const JointMotion between = at(1005 * kMs);
  EXPECT_TRUE(between.position.isApprox(test::joints({0.1, -0.375, 1.225, -0.825}), 1e-15));
  EXPECT_TRUE(between.velocity.isApprox(test::joints({0.0, 0.2, 0.25, 0.25}), 1e-15));
  EXPECT_TRUE(between.acceleration.isApprox(test::joints({0.0, 20.0, 10.0, -10.0}), 1e-12));
}

/// Two publishers repeat one joint state, or one buffer releases two: a count of 1 mrad in 10 us is not 100 rad/s.
TEST_F(Joints, MoveAsBeforeIfTheyCameTogether) {
  for (int i = 0; i < 5; ++i) {
    const double angle = 0.01 * i;
    buffer_.update(20 * i * kMs, kFour, {0.0, angle, 1.0, -0.8}, {});
    buffer_.update(20 * i * kMs + kMs / 100, kFour, {0.0, angle + 1e-3, 1.0, -0.8}, {});
  }
  const JointMotion motion = at(80 * kMs + kMs / 100);
  EXPECT_NEAR(motion.position[1], 0.041, 1e-12);
  EXPECT_NEAR(motion.velocity[1], 0.45, 0.01) << "over the 20 ms before";
  EXPECT_LT(std::abs(motion.acceleration[1]), 5.0);
}

TEST_F(Joints, MayComeInPartsInAnyOrderAmongOthers) {
  EXPECT_FALSE(buffer_.update(0, {"wheel"}, {3.0}, {}));
  EXPECT_TRUE(buffer_.update(0, {"hammer_joint", "wheel", "boom_joint"}, {-0.8, 3.0, -0.4}, {}));
  JointMotion motion;
  auto fault = buffer_.at(kMs, motion);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, JointFault::Kind::kMissing);
  EXPECT_EQ(buffer_.name(fault->joint), "swing_joint");
  EXPECT_EQ(buffer_.complaints(kMs), (Names{"swing_joint: never heard", "arm_joint: never heard"}));
  EXPECT_TRUE(buffer_.update(kMs, {"swing_joint"}, {0.2}, {}));
  EXPECT_TRUE(buffer_.update(2 * kMs, {"wheel", "arm_joint"}, {0.0, 1.2}, {}));
  EXPECT_EQ(at(2 * kMs).position, test::joints({0.2, -0.4, 1.2, -0.8}));
  EXPECT_TRUE(buffer_.complaints(2 * kMs).empty());
}

TEST_F(Joints, DifferencesFollowAParabolaExactlyWithoutVelocities) {
  const double a = 0.6, v = -0.3;
  const auto position = [&](double t) { return 1.0 + v * t + 0.5 * a * t * t; };
  // Steps of different lengths.
  const int stamps[] = {0, 20, 50, 60, 100};
  for (int ms : stamps) buffer_.update(ms * kMs, kFour, {0.0, 0.0, position(1e-3 * ms), 0.0}, {});
  const JointMotion between = at(80 * kMs);
  EXPECT_NEAR(between.velocity[2], v + a * 0.080, 1e-14);  // slope of a chord, exact at its middle
  EXPECT_NEAR(between.acceleration[2], a, 1e-12);
  EXPECT_NEAR(between.position[2], position(0.080), 0.125 * a * 0.04 * 0.04 * 1.01);
  EXPECT_EQ(between.velocity[1], 0.0);
}

TEST_F(Joints, BadValuesAreRefusedAndCounted) {
  ASSERT_TRUE(buffer_.update(0, kFour, {0.0, 0.0, 1.0, 0.0}, {}));
  EXPECT_FALSE(buffer_.update(10 * kMs, {"arm_joint"}, {kNaN}, {}));
  EXPECT_FALSE(buffer_.update(10 * kMs, {"arm_joint"}, {std::numeric_limits<double>::infinity()}, {}));
  EXPECT_EQ(buffer_.refusals().not_finite, 2U);
  EXPECT_FALSE(buffer_.update(10 * kMs, {"arm_joint"}, {}, {}));
  EXPECT_EQ(buffer_.refusals().short_array, 1U);
  EXPECT_EQ(at(10 * kMs).position[2], 1.0);
  // A position with a bad or absent velocity is still used.
  EXPECT_TRUE(buffer_.update(20 * kMs, {"arm_joint"}, {1.02}, {kNaN}));
  EXPECT_EQ(buffer_.refusals().not_finite, 3U);
  EXPECT_NEAR(at(20 * kMs).velocity[2], 1.0, 1e-12);
  EXPECT_TRUE(buffer_.update(30 * kMs, {"boom_joint", "arm_joint"}, {0.0, 1.03}, {0.0}));
  EXPECT_EQ(buffer_.refusals().short_array, 2U);
  EXPECT_NEAR(at(30 * kMs).velocity[2], 1.0, 1e-12);
}

/// One jump is a damaged message. Two in a row mean that the joint was elsewhere all the time.
TEST_F(Joints, AcceptAJumpFromTheSecondReadingOn) {
  ASSERT_TRUE(buffer_.update(0, kFour, {0.0, 0.0, 1.0, 0.0}, {}));
  EXPECT_FALSE(buffer_.update(20 * kMs, {"arm_joint"}, {1.3}, {}));
  EXPECT_TRUE(buffer_.update(40 * kMs, {"arm_joint"}, {1.01}, {}));
  EXPECT_EQ(at(40 * kMs).position[2], 1.01);
  EXPECT_FALSE(buffer_.update(60 * kMs, {"arm_joint"}, {0.0}, {}));
  EXPECT_TRUE(buffer_.update(80 * kMs, {"arm_joint"}, {0.01}, {}));
  EXPECT_EQ(at(80 * kMs).position[2], 0.01);
  EXPECT_EQ(buffer_.refusals().jumps, 2U);
  EXPECT_TRUE(buffer_.update(1080 * kMs, {"arm_joint"}, {2.0}, {})) << "2 rad in a second";
}

TEST_F(Joints, RefuseALateStateAndAcceptTimeRunningBack) {
  buffer_.update(1000 * kMs, kFour, {0.0, 0.0, 1.0, 0.0}, {});
  EXPECT_FALSE(buffer_.update(990 * kMs, kFour, {0.0, 0.0, 2.0, 0.0}, {}));
  EXPECT_TRUE(buffer_.update(1010 * kMs, kFour, {0.0, 0.0, 1.1, 0.0}, {}));
  EXPECT_NEAR(at(1010 * kMs).position[2], 1.1, 0.0);
  EXPECT_FALSE(buffer_.update(0, kFour, {0.0, 0.0, 2.0, 0.0}, {}));
  EXPECT_TRUE(buffer_.update(10 * kMs, kFour, {0.0, 0.0, 2.1, 0.0}, {}));
  EXPECT_EQ(at(10 * kMs).position[2], 2.1);
  EXPECT_EQ(at(10 * kMs).velocity[2], 0.0);  // no difference across the jump in time
  EXPECT_EQ(buffer_.refusals().out_of_order, 8U);
}

TEST_F(Joints, AJointThatTurnsFreelyTakesTheShorterWay) {
  std::mt19937 random(3);
  const auto planar = test::PlanarChain<2>::random(random);
  const Checked<Chain> chain = Chain::make(planar.urdf(), {"base_link", "tip", {}});
  ASSERT_TRUE(chain.value);
  JointBuffer winding(*chain.value, accelerated());
  winding.update(0, {"j0", "j1"}, {3.1, 0.0}, {});
  winding.update(10 * kMs, {"j0", "j1"}, {-3.1, 0.5}, {});
  JointMotion motion;
  ASSERT_FALSE(winding.at(5 * kMs, motion));
  EXPECT_NEAR(motion.position[0], std::acos(-1.0), 1e-12);
  EXPECT_NEAR(motion.velocity[0], (2.0 * std::acos(-1.0) - 6.2) / 0.010, 1e-9);
}

TEST_F(Joints, ACrankSampleMayLieFarBehind) {
  for (int i = 0; i < 1000; ++i) buffer_.update(i * kMs, kFour, {0.0, 0.0, 1.0 + 1e-3 * i, 0.0}, {});
  EXPECT_NEAR(at(940 * kMs + kMs / 2).position[2], 1.9405, 1e-12);
  EXPECT_NEAR(at(900 * kMs).position[2], 1.936, 1e-12);  // older than all stored states: the oldest
}

}  // namespace
}  // namespace hammer_loads
