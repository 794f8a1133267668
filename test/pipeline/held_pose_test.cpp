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

}  // namespace
}  // namespace hammer_loads
