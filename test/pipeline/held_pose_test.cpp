#include "hammer_loads/pipeline/held_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr double kStep = 1e-3;  // [s]

JointMotion joint(double position, double velocity) {
  JointMotion motion;
  motion.position = JointVector::Constant(1, position), motion.velocity = JointVector::Constant(1, velocity);
  motion.acceleration = JointVector::Constant(1, 7.0);
  return motion;
}

TEST(HeldPose, FollowsAJointThatIsDrivenSlowlyWithoutLag) {
  constexpr double kAcceleration = 0.004;  // [rad/s2]
  HeldPose held;
  for (double t = 0.0; t < 10.0; t += kStep) {
    const double angle = 0.3 + 0.5 * kAcceleration * t * t;
    held.follow(joint(angle, kAcceleration * t), kStep);
    if (t < 8.0) continue;
    ASSERT_FALSE(held.isDriven());
    ASSERT_NEAR(held.motion().position[0], angle, 2e-5) << t;
    ASSERT_NEAR(held.motion().velocity[0], kAcceleration * t, 1.1 * kAcceleration) << t;
    ASSERT_NEAR(held.motion().acceleration[0], kAcceleration, 0.02 * kAcceleration) << t;
  }
}

/// The operator swings the boom; what of that is seen late or not is an error of the torque of its inertia.
TEST(HeldPose, KnowsMostOfASlowSwingsAcceleration) {
  constexpr double kSwing = 0.04, kPeriod = 14.0;  // [rad], [s]
  constexpr double kRate = kTwoPi / kPeriod, kLargest = kSwing * kRate * kRate;
  HeldPose held;
  double worst = 0.0;
  for (double t = 0.0; t < 40.0; t += kStep) {
    const double angle = kSwing * std::sin(kRate * t);
    held.follow(joint(angle, 0.0), kStep);
    if (t > 10.0) worst = std::max(worst, std::abs(held.motion().acceleration[0] + kRate * kRate * angle));
  }
  EXPECT_LT(worst, 0.3 * kLargest);
}

/// A vibration that is not known at first is no acceleration of the operator's.
TEST(HeldPose, HasNoAccelerationOfItsOwnUntilItHasSettled) {
  HeldPose held;
  double largest = 0.0;
  const auto follow = [&](double angle, double from, double to) {
    for (double t = from; t < to; t += kStep) {
      held.follow(joint(angle, 0.0), kStep);
      if (held.motion().acceleration[0] != 7.0) largest = std::max(largest, std::abs(held.motion().acceleration[0]));
    }
  };
  follow(0.3, 0.0, 6.0);
  EXPECT_EQ(held.motion().acceleration[0], 0.0);
  held.follow(joint(0.303, 0.0), 1.2);
  EXPECT_EQ(held.motion().acceleration[0], 7.0) << "as measured";
  follow(0.303, 0.0, 0.2);
  follow(0.3, 0.2, 6.0);
  EXPECT_NE(held.motion().acceleration[0], 7.0);
  EXPECT_LT(largest, 3e-3);
}

TEST(HeldPose, LeavesLittleOfAVibration) {
  for (const auto& [frequency, left] : {std::pair{3.4, 0.29}, std::pair{9.0, 0.11}}) {
    HeldPose held;
    double largest = 0.0, fastest = 0.0;
    for (double t = 0.0; t < 10.0; t += kStep) {
      const double rate = kTwoPi * frequency;
      held.follow(joint(0.3 + 0.007 * std::sin(rate * t), 0.007 * rate * std::cos(rate * t)), kStep);
      if (t < 8.0) continue;
      largest = std::max(largest, std::abs(held.motion().position[0] - 0.3));
      fastest = std::max(fastest, std::abs(held.motion().velocity[0]));
    }
    EXPECT_LT(largest, left * 0.007) << frequency;
    EXPECT_LT(fastest, 0.1 * 0.007 * kTwoPi * frequency) << frequency;
  }
}

/// Blows every 0.21 s shake the joint as fast as the operator drives it.
TEST(HeldPose, KnowsTheOperatorsRateAtABlow) {
  HeldPose held;
  EXPECT_EQ(held.rateAtBlow().size(), 0);
  double next_blow = 0.0, worst = 0.0;
  for (double t = 0.0; t < 20.0; t += kStep) {
    const double shaken = 0.007 * std::sin(kTwoPi * t / 0.21), rate = 0.15 * std::cos(t);
    held.follow(joint(0.15 * std::sin(t) + shaken, 0.0), kStep);
    if (t < next_blow) continue;
    next_blow += 0.21;
    held.struck();
    if (t > 3.0) worst = std::max(worst, std::abs(held.rateAtBlow()[0] - rate));
  }
  EXPECT_LT(worst, 0.1 * 0.15);
  held.follow(joint(2.0, 0.0), kStep);
  EXPECT_EQ(held.rateAtBlow()[0], 0.0) << "the joint is another's";
}

TEST(HeldPose, IsAsMeasuredAtTheStartAndWhileDriven) {
  HeldPose held;
  bool was_driven = false;
  for (double t = 0.0; t < 12.0; t += kStep) {
    const double speed = t > 5.0 && t < 7.0 ? 0.1 : 0.0, angle = 0.1 * std::min(2.0, std::max(0.0, t - 5.0));
    held.follow(joint(angle, speed), kStep);
    const bool surely = t < 0.9 || (t > 6.0 && t < 8.5);
    if (surely) {
      ASSERT_TRUE(held.isDriven()) << t;
      ASSERT_EQ(held.motion().position[0], angle) << t;
      ASSERT_EQ(held.motion().velocity[0], speed) << t;
    }
    was_driven = was_driven || (t > 2.0 && held.isDriven());
  }
  EXPECT_TRUE(was_driven);
  EXPECT_FALSE(held.isDriven());
}

}  // namespace
}  // namespace hammer_loads
