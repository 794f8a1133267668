// Weight with tilts of the description and of the ground, compared with rotations multiplied by hand.
#include "hammer_loads/boom/gravity.h"

#include <gtest/gtest.h>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

using test::kGravity;

/// Returns the rotation matrix about a coordinate axis.
Eigen::Matrix3d about(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  R(a, a) = c, R(a, b) = -s, R(b, a) = s, R(b, b) = c;
  return R;
}

/// Returns the shipped description with the hull rotated on its bracket and an inclined foot of the boom.
std::string tiltedUrdf() {
  return test::withFirstReplaced(
      test::withFirstReplaced(test::shippedUrdf(), "<origin xyz=\"0.10 0 -0.55\" rpy=\"0 0 0\"/>",
                              "<origin xyz=\"0.10 0 -0.55\" rpy=\"0.05 0.4 -0.1\"/>"),
      "<origin xyz=\"0.25 0 0.40\" rpy=\"0 0 0\"/>", "<origin xyz=\"0.25 0 0.40\" rpy=\"0.02 -0.03 0.01\"/>");
}

TEST(Gravity, FollowsTheTiltsOfTheDescriptionInTheTip) {
  const Checked<Chain> made = Chain::make(tiltedUrdf(), {});
  ASSERT_TRUE(made.value);
  std::mt19937 random(52);
  for (int i = 0; i < 100; ++i) {
    const JointVector q = test::randomPosition(*made.value, random);
    const BaseTilt base{test::between(random, -0.3, 0.3), test::between(random, -0.3, 0.3)};
    const Eigen::Matrix3d foot = about(2, 0.01) * about(1, -0.03) * about(0, 0.02);
    const Eigen::Matrix3d mount = about(2, -0.1) * about(1, 0.4) * about(0, 0.05);
    const Eigen::Matrix3d R_WH =
        about(1, base.pitch) * about(0, base.roll) * about(2, q[0]) * foot * about(1, q[1] + q[2] + q[3]) * mount;
    const Eigen::Vector3d expected = R_WH.transpose() * Eigen::Vector3d(0.0, 0.0, -kGravity);
    const Eigen::Vector3d g_B = gravityInRoot(kGravity, base);
    EXPECT_LT((gravityInTip(*made.value, q, g_B) - expected).norm(), 1e-13);
  }
}

TEST(Gravity, JointTorquesOfABaseThatLeansAreThoseOfALeaningDescription) {
  // The description has the tilt of the ground: base_link is upright, and the swing axis is tilted.
  const BaseTilt base{0.12, -0.2};
  // R_WB = Ry(pitch) Rx(roll) is rpy = (roll, pitch, 0) of the first joint.
  const Checked<Boom> tilted =
      Boom::make(test::withFirstReplaced(test::shippedUrdf(), "<origin xyz=\"0 0 0.60\" rpy=\"0 0 0\"/>",
                                         "<origin xyz=\"0 0 0.60\" rpy=\"0.12 -0.2 0\"/>"));
  ASSERT_TRUE(tilted.value);
  Boom in_description = *tilted.value, on_ground = *Boom::make(test::shippedUrdf()).value;
  const JointVector zero = JointVector::Zero(4);
  const JointMotion motion{test::workingPosition(), zero, zero};
  in_description.move(motion, {0.0, 0.0, -kGravity});
  on_ground.move(motion, gravityInRoot(kGravity, base));
  BoomLoads a, b;
  ASSERT_TRUE(in_description.loads({}, true, a));
  ASSERT_TRUE(on_ground.loads({}, true, b));
  EXPECT_LT((a.weight - b.weight).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_GT(std::abs(a.weight[0]), 100.0);  // the roll loads the swing joint
  EXPECT_LT((in_description.gravityAtTip() - on_ground.gravityAtTip()).norm(), 1e-14);
}

}  // namespace
}  // namespace hammer_loads
