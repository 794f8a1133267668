// Modes of the shipped boom: equation of motion, effect of the weight, soft oil, and zero moment arm of a cylinder.

#include <gtest/gtest.h>

#include "boom/shipped_boom.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

using test::kZero;
using test::ShippedBoom;

TEST_F(ShippedBoom, ModesSolveTheEquationOfMotion) {
  std::mt19937 random(41);
  for (int i = 0; i < 100; ++i) {
    // Modes may belong to a pose a little apart from the present one, but their matrices belong to the same pose.
    pose(test::randomPosition(boom_.chain(), random));
    const BoomModes& m = modes();
    ASSERT_EQ(m.count, 3);
    const Eigen::Matrix3d M = m.mass.bottomRightCorner<3, 3>(), S = m.shape;
    const Eigen::Matrix3d K = m.stiffness.asDiagonal();
    EXPECT_LT((S.transpose() * M * S - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Eigen::Vector3d omega = m.omega;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d residual = K * S.col(k) - omega[k] * omega[k] * M * S.col(k);
      EXPECT_LT(residual.norm(), 1e-11 * (K * S.col(k)).norm());
      EXPECT_GE(omega[k], omega[std::max(k - 1, 0)]);
    }
  }
}

TEST_F(ShippedBoom, IsStiffenedOrSoftenedByItsWeight) {
  std::mt19937 random(43);
  for (int i = 0; i < 30; ++i) {
    const JointVector q = test::randomPosition(boom_.chain(), random);
    const Eigen::Vector3d g_B = test::randomVector(random, 10.0);
    const auto torqueAt = [&](const JointVector& position) {
      ChainPose there;
      forwardKinematics(boom_.chain(), position, there);
      return jointTorqueOfWeight(boom_.chain(), there, g_B);
    };
    Eigen::Matrix4d slope;
    constexpr double h = 1e-4;
    for (int j = 0; j < 4; ++j) {
      const JointVector step = h * JointVector::Unit(4, j);
      slope.col(j) = (torqueAt(q + step) - torqueAt(q - step)) / (2.0 * h);
    }
    const Eigen::Matrix4d K = weightStiffness(boom_.chain(), q, g_B);
    ASSERT_LT((K + slope).norm(), 1e-6 * slope.norm());
    // To first order the weight changes the square of a mode's frequency by shape^T K shape.
    vibration().reset();  // computes new modes at each pose
    pose(q);
    if (modes().count == 0) continue;  // zero moment arm
    const BoomModes without = modes();
    vibration().reset();
    boom_.moveCompliant({q, kZero, kZero}, g_B);
    for (int k = 0; k < 3; ++k) {
      const double gained = without.shape.col(k).dot(K.bottomRightCorner<3, 3>() * without.shape.col(k));
      const double square = without.omega[k] * without.omega[k];
      EXPECT_NEAR(modes().omega[k] * modes().omega[k] - square, gained, 0.02 * std::abs(gained) + 1e-5 * square);
    }
  }
}

TEST(Vibration, OilThatCouldNotHoldTheWeightHasItsOwnModes) {
  BoomParameters soft = test::shippedBoomParameters();
  soft.bulk_modulus = 1.0;
  Boom boom = Boom::make(test::shippedUrdf(), soft).value.value();
  boom.moveCompliant({test::workingPosition(), kZero, kZero}, test::kLevel);
  ASSERT_EQ(boom.vibration().modes().count, 3);
  const JointVector omega = boom.vibration().modes().omega;
  EXPECT_TRUE(omega.allFinite());
  EXPECT_GT(omega.minCoeff(), 0.0);
}

TEST_F(ShippedBoom, KnowsNothingAtADeadCentre) {
  BoomParameters parameters = boom_.parameters();
  CylinderParameters& p = parameters.cylinders[0];
  p.base_x = 0.25 - 1.0, p.base_z = 0.40, p.rod_x = 1.0, p.rod_z = 0.0, p.closed_length = 1.5, p.stroke = 0.6;
  Checked<Boom> made = Boom::make(test::shippedUrdf(), parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  Boom& boom = *made.value;
  const JointVector torque = test::joints({0.0, 1e4, 2e3, 1e3});
  const auto at = [&](double angle) {
    boom.moveCompliant({test::joints({0.0, angle, 1.2, -0.8}), kZero, kZero}, Eigen::Vector3d::Zero());
  };
  at(0.4), at(0.4);
  boom.vibration().advance(0.02, {torque, torque, torque});
  EXPECT_TRUE(boom.vibration().known());
  EXPECT_GT(boom.vibration().energy(), 0.0);
  at(0.0), at(0.0);
  EXPECT_FALSE(boom.vibration().known());
  EXPECT_TRUE(boom.vibration().modes().zero_moment_arm);
  boom.vibration().advance(0.02, {torque, torque, torque});
  EXPECT_TRUE(boom.vibration().displacement().isZero(0.0));
  EXPECT_TRUE(boom.vibration().torque().isZero(0.0));
  EXPECT_EQ(boom.vibration().energy(), 0.0);
  BoomLoads loads;
  boom.loads({}, false, loads);
  EXPECT_TRUE(loads.cylinder[0].zero_moment_arm);
  EXPECT_FALSE(loads.cylinder[1].zero_moment_arm);
  at(0.4), at(0.4);
  EXPECT_TRUE(boom.vibration().known());
  EXPECT_EQ(boom.vibration().energy(), 0.0);
}

}  // namespace
}  // namespace hammer_loads
