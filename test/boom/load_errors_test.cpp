// Variances by a covariance of errors against the squares of what each error does by itself.
#include "hammer_loads/boom/load_errors.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "boom/booms.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

class LoadErrorsOfTheBoom : public testing::Test {
 protected:
  JointVector acceleration() {
    return JointVector::NullaryExpr(4, [this] { return draw_(random_); });
  }
  Wrench tip(bool across) {
    const double y = across ? 1.0 : 0.0;
    return {{draw_(random_), y * draw_(random_), draw_(random_)},
            {y * draw_(random_), draw_(random_), y * draw_(random_)}};
  }
  /// In the order of the inputs.
  Eigen::VectorXd inputs(const JointVector& of_joints, const Wrench& w) const {
    Eigen::VectorXd all(9);
    for (int i = 0; i < 3; ++i) all[i] = of_joints[cylinders_[static_cast<std::size_t>(i)].joint()];
    all.tail<6>() << w.force.x(), w.force.z(), w.torque.y(), w.force.y(), w.torque.x(), w.torque.z();
    return all;
  }
  Eigen::MatrixXd response(Eigen::Index inputs) {
    return Eigen::MatrixXd::NullaryExpr(11, inputs, [this] { return draw_(random_); });
  }

  const std::vector<Cylinder> cylinders_ = test::shippedBoom().cylinders();
  std::mt19937 random_{81};
  std::normal_distribution<> draw_;
};

TEST_F(LoadErrorsOfTheBoom, AddUpByTheirSquaresTheLargerOfTwo) {
  for (const bool across : {false, true}) {
    for (const bool either : {false, true}) {
      LoadErrors errors(cylinders_);
      const Eigen::Index size = across ? 9 : 6;
      const Eigen::MatrixXd R = response(size);
      Eigen::VectorXd right = Eigen::VectorXd::Zero(R.rows());
      for (int i = 0; i < 5; ++i) {
        const JointVector a = acceleration();
        const Wrench w = tip(across);
        errors.add(a, w);
        right += (R * inputs(a, w).head(size)).cwiseAbs2();
      }
      if (either) {
        const JointVector one = acceleration(), other = acceleration();
        errors.addLarger(one, other);
        right += (R * inputs(one, {}).head(size)).cwiseAbs2().cwiseMax((R * inputs(other, {}).head(size)).cwiseAbs2());
      }
      ASSERT_EQ(errors.size(), size);
      Eigen::VectorXd variance = Eigen::VectorXd::Constant(R.rows(), -1.0);
      errors.findVariances(R, variance);
      EXPECT_LT((variance - right).norm(), 1e-13 * right.norm());
    }
  }
}

TEST_F(LoadErrorsOfTheBoom, AreNeverBelowZeroWhateverRoundingMakes) {
  for (int i = 0; i < 1000; ++i) {
    LoadErrors errors(cylinders_);
    const JointVector a = acceleration();
    const Wrench w = tip(false);
    errors.add(a, w);
    const Eigen::VectorXd by = inputs(a, w).head(6);
    Eigen::MatrixXd R = response(6);
    R -= (R * by) * by.transpose() / by.squaredNorm();  // what this error does not do
    Eigen::VectorXd variance(R.rows());
    errors.findVariances(R, variance);
    EXPECT_GE(variance.minCoeff(), 0.0);
    EXPECT_LT(variance.maxCoeff(), 1e-12 * square(R.norm()) * by.squaredNorm());
  }
}

}  // namespace
}  // namespace hammer_loads
