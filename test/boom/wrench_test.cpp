#include "hammer_loads/boom/wrench.h"

#include <gtest/gtest.h>

#include <random>

#include "boom/booms.h"

namespace hammer_loads {
namespace {

/// Returns a random pose. Its rotation is rounded from long double, so that the errors are those of the shift.
Pose randomPose(std::mt19937& random) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::Quaternion<long double>(test::between(random, -1, 1), test::between(random, -1, 1),
                                              test::between(random, -1, 1), test::between(random, -1, 1))
                   .normalized()
                   .toRotationMatrix()
                   .cast<double>();
  X.translation() = test::randomVector(random, 5.0);
  return X;
}

/// Returns the shift as a matrix on (force, torque): [R 0; [p]x R  R].
Eigen::Matrix<double, 6, 6> shiftMatrix(const Pose& X_QP) {
  const Eigen::Matrix3d R = X_QP.linear();
  const Eigen::Vector3d p = X_QP.translation();
  Eigen::Matrix3d p_cross;
  p_cross << 0.0, -p.z(), p.y(), p.z(), 0.0, -p.x(), -p.y(), p.x(), 0.0;
  Eigen::Matrix<double, 6, 6> shift = Eigen::Matrix<double, 6, 6>::Zero();
  shift.topLeftCorner<3, 3>() = R;
  shift.bottomRightCorner<3, 3>() = R;
  shift.bottomLeftCorner<3, 3>() = p_cross * R;
  return shift;
}

TEST(WrenchShift, EqualsTheMatrixAndConservesPower) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const Pose X = randomPose(random);
    const Wrench w = test::randomWrench(random);
    Eigen::Matrix<double, 6, 1> stacked;
    stacked << w.force, w.torque;
    const Eigen::Matrix<double, 6, 1> by_matrix = shiftMatrix(X) * stacked;
    const Wrench by_function = shifted(X, w);
    EXPECT_LT((by_matrix.head<3>() - by_function.force).norm(), 1e-15 * w.force.norm());
    const double size = w.torque.norm() + X.translation().norm() * w.force.norm();
    EXPECT_LT((by_matrix.tail<3>() - by_function.torque).norm(), 2e-15 * size);

    // The power f v + t omega on a rigid body does not depend on point and axes.
    const Eigen::Vector3d v_P = test::randomVector(random, 2.0), omega_P = test::randomVector(random, 2.0);
    const Eigen::Vector3d omega_Q = X.linear() * omega_P;
    const Eigen::Vector3d v_Q = X.linear() * v_P - omega_Q.cross(X.translation());
    const double power = w.force.dot(v_P) + w.torque.dot(omega_P);
    EXPECT_NEAR(by_function.force.dot(v_Q) + by_function.torque.dot(omega_Q), power, 1e-13 * size);
  }
}

}  // namespace
}  // namespace hammer_loads
