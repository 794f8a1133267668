// Variances of results from the covariance of errors.
#include "hammer_loads/boom/load_errors.h"

#include <gtest/gtest.h>

#include <random>

#include "boom/booms.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

TEST(LoadErrorsOfTheBoom, AreNeverBelowZeroWhateverRoundingMakes) {
  const std::vector<Cylinder> cylinders = test::shippedBoom().cylinders();
  std::mt19937 random(81);
  std::normal_distribution<> normal;
  const auto draw = [&] { return normal(random); };
  for (int i = 0; i < 1000; ++i) {
    LoadErrors errors(cylinders);
    const JointVector a = JointVector::NullaryExpr(4, draw);
    const Wrench w{{draw(), 0.0, draw()}, {0.0, draw(), 0.0}};
    errors.add(a, w);
    Eigen::VectorXd by(6);  // in the order of the inputs
    for (int k = 0; k < 3; ++k) by[k] = a[cylinders[static_cast<std::size_t>(k)].joint()];
    by.tail<3>() << w.force.x(), w.force.z(), w.torque.y();
    Eigen::MatrixXd R = Eigen::MatrixXd::NullaryExpr(11, 6, draw);
    R -= (R * by) * by.transpose() / by.squaredNorm();  // results without an effect of this error
    Eigen::VectorXd variance(R.rows());
    errors.findVariances(R, variance);
    EXPECT_GE(variance.minCoeff(), 0.0);
    EXPECT_LT(variance.maxCoeff(), 1e-12 * square(R.norm()) * by.squaredNorm());
  }
}

}  // namespace
}  // namespace hammer_loads
