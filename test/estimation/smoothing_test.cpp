// The smoother against everything at once: batch least squares, for given constants, and by finite differences of it.
#include "hammer_loads/estimation/smoothing.h"

#include <gtest/gtest.h>

#include "estimation/linear_machine.h"

namespace hammer_loads::test {
namespace {

using Smoothing = LinearMachine<3, 2>;

TEST(Smoothing, EqualsBatchLeastSquaresForGivenConstants) {
  const Smoothing machine(11);
  constexpr int kSteps = 20;
  const Smoothing::Run run = machine.run(12, kSteps);
  std::vector<Smoothing::Belief> belief{machine.begin()}, predicted;
  std::vector<Smoothing::Vector> mean{Smoothing::Vector::Zero()}, predicted_mean;
  for (const double z : run.z) {
    Smoothing::Belief next = belief.back();
    Smoothing::Vector x = mean.back();
    machine.predict(next, x);
    predicted.push_back(next), predicted_mean.push_back(x);
    machine.correct(next, x, z);
    belief.push_back(next), mean.push_back(x);
  }
  const Eigen::Vector2d given = Eigen::Vector2d::Zero(), exact = Eigen::Vector2d::Constant(1e-4);
  const Smoothing::Batch batch = machine.batch(run.z, given, exact);
  for (std::size_t k = kSteps; k-- > 0;) {
    const auto smoothed =
        smooth(belief[k], machine.F, predicted[k], belief[k + 1], Smoothing::Vector(mean[k + 1] - predicted_mean[k]));
    ASSERT_TRUE(smoothed);
    belief[k] = smoothed->belief;
    mean[k] += smoothed->gain * (mean[k + 1] - predicted_mean[k]);
    const int at = static_cast<int>(k);
    EXPECT_TRUE(mean[k].isApprox(batch.x(at), 1e-5)) << k;
    EXPECT_TRUE(belief[k].covariance.isApprox(batch.of(at), 1e-5)) << k;
    for (int c = 0; c < 2; ++c) {
      const Smoothing::Batch beside = machine.batch(run.z, Eigen::Vector2d::Unit(c), exact);
      EXPECT_LT((belief[k].by_constant.col(c) + (beside.x(at) - batch.x(at))).norm(), 1e-4) << k << ' ' << c;
    }
  }
}

TEST(Smoothing, SaysHowFarTheLaterBeliefIsFromThePredictedOne) {
  const Smoothing machine(13);
  Smoothing::Belief before = machine.begin(), predicted = before;
  Smoothing::Vector mean = Smoothing::Vector::Zero();
  machine.predict(predicted, mean);
  const Smoothing::Vector change(0.3, -0.2, 0.5);
  const auto smoothed = smooth(before, machine.F, predicted, predicted, change);
  ASSERT_TRUE(smoothed);
  EXPECT_NEAR(smoothed->distance, change.dot(predicted.covariance.inverse() * change), 1e-12);
  EXPECT_TRUE(smoothed->belief.covariance.isApprox(before.covariance, 1e-12));  // nothing was learned
}

TEST(Smoothing, RefusesASingularPrediction) {
  const Smoothing machine(14);
  Smoothing::Belief before = machine.begin(), predicted = before;
  ASSERT_TRUE(smooth(before, machine.F, predicted, predicted, Smoothing::Vector(0.1, 0.1, 0.1)));
  predicted.covariance(1, 1) = 0.0;
  EXPECT_FALSE(smooth(before, machine.F, predicted, predicted, Smoothing::Vector(0.1, 0.1, 0.1)));
  predicted.covariance.setOnes();
  EXPECT_FALSE(smooth(before, machine.F, predicted, predicted, Smoothing::Vector(0.1, 0.1, 0.1)));
}

}  // namespace
}  // namespace hammer_loads::test
