// When a boom counts as held and a crank as sound: each time, rate and angle within a factor of 1.25 of what is said.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/pipeline/crank_trust.h"
#include "hammer_loads/pipeline/held_pose.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr double kPoseStep = 1e-3;  // [s]
constexpr double kMeasured = 7.0;   // acceleration of the joint by its sensor [rad/s2]

/// One joint, by its angle and rate.
class OneJoint {
 public:
  HeldPose held;

  void run(double time, double rate = 0.0) {
    for (int i = 0; i < std::lround(time / kPoseStep); ++i) {
      angle_ += rate * kPoseStep;
      follow(kPoseStep);
    }
  }
  void jump(double angle) { angle_ += angle; }
  void follow(double step) {
    JointMotion motion;
    motion.position = JointVector::Constant(1, angle_);
    motion.velocity = JointVector::Zero(1);
    motion.acceleration = JointVector::Constant(1, kMeasured);
    held.follow(motion, step);
  }
  bool isSettled() const { return held.motion().acceleration[0] != kMeasured; }

 private:
  double angle_{};
};

TEST(PoseAndTrust, AJointCountsAsDrivenAtTheStart) {
  OneJoint joint;
  joint.run(0.8);
  EXPECT_TRUE(joint.held.isDriven());
  joint.run(0.45);
  EXPECT_FALSE(joint.held.isDriven());
  joint.run(1.75);  // 3 of 1 + 2.5 s
  EXPECT_FALSE(joint.isSettled());
  joint.run(1.1);
  EXPECT_TRUE(joint.isSettled());
}

TEST(PoseAndTrust, AJointIsFollowedByFiltersOfHalfASecond) {
  OneJoint joint;
  joint.run(5.0);
  joint.jump(0.02);
  joint.run(0.5);
  EXPECT_NEAR(joint.held.slowAngle()[0] / 0.02, 1.0 - 2.0 * std::exp(-1.0), 0.05);
}

TEST(PoseAndTrust, AJointThatWindsBeginsAnew) {
  const auto beginsAnew = [](double jump, double step) {
    OneJoint joint;
    joint.run(5.0);
    joint.jump(jump);
    joint.follow(step);
    return joint.held.slowAngle()[0] == jump;
  };
  EXPECT_FALSE(beginsAnew(0.8 * 0.5, kPoseStep));
  EXPECT_TRUE(beginsAnew(1.25 * 0.5, kPoseStep));
  EXPECT_FALSE(beginsAnew(0.8 * 0.03, 0.7));
  EXPECT_TRUE(beginsAnew(1.25 * 0.03, 0.7));
}

TEST(PoseAndTrust, AJointIsDrivenAboveARateAndForSomeTimeAfterIt) {
  OneJoint slow, fast;
  slow.run(10.0, 0.8 * 0.05);
  EXPECT_FALSE(slow.held.isDriven());
  fast.run(10.0, 1.25 * 0.05);
  EXPECT_TRUE(fast.held.isDriven());
  fast.run(2.0);  // (1 + x) exp(-x) = 0.8 after x = 0.82 of 0.5 s; then 2 s
  EXPECT_TRUE(fast.held.isDriven());
  fast.run(0.9);
  EXPECT_FALSE(fast.held.isDriven());
}

TEST(PoseAndTrust, ACrankThatContradictsTheModelIsRefused) {
  for (const double part : {0.8, 1.25}) {
    CrankTrust trust{CrankSensor{}};
    trust.follow(0.0, part * 4.0, kPoseStep);
    EXPECT_EQ(trust.isInconsistent(), part > 1.0);
  }
}

TEST(PoseAndTrust, TwoStrokesInARowThatAreNotBelieved) {
  CrankTrust trust{CrankSensor{}};
  double angle = 0.0;
  const auto stroke = [&](bool believed) {
    for (int i = 0; i < 20; ++i) trust.follow(angle += 0.1, 1.0, kPoseStep);
    trust.passBlow(believed);
    return trust.isInconsistent();
  };
  EXPECT_FALSE(stroke(false));
  EXPECT_FALSE(stroke(true));
  EXPECT_FALSE(stroke(false));
  EXPECT_TRUE(stroke(false));
  EXPECT_TRUE(trust.isLost());
  EXPECT_TRUE(stroke(false));
  EXPECT_FALSE(stroke(true)) << "one ends it";
  stroke(false);
  trust.begin();
  EXPECT_FALSE(stroke(false)) << "what was lost in a gap is no contradiction";
}

TEST(PoseAndTrust, ACrankThatRocksAtTheDeadCentreSaysNothing) {
  CrankTrust trust{CrankSensor{}};
  for (int i = 0; i < 10; ++i) {
    trust.follow(i % 2 == 0 ? 0.4 : -0.4, 1.0, kPoseStep);
    trust.passBlow(false);
  }
  EXPECT_FALSE(trust.isInconsistent());
}

TEST(PoseAndTrust, ACrankHasRunUpAfterARadian) {
  for (const double part : {0.8, 1.25}) {
    CrankTrust trust{CrankSensor{}};
    for (int i = 0; i <= 100; ++i) trust.follow(0.01 * part * i, 1.0, kPoseStep);
    EXPECT_EQ(trust.hasRunUp(), part > 1.0);
  }
}

}  // namespace
}  // namespace hammer_loads
