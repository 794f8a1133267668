// A belief with considered constants, compared with filters that estimate the constants, with batch least squares, and
// with machines drawn from the prior.
#include "hammer_loads/estimation/gaussian_belief.h"

#include <gtest/gtest.h>

#include "estimation/linear_machine.h"
#include "hammer_loads/crank/constant_errors.h"

namespace hammer_loads::test {
namespace {

constexpr int kN = 4, kC = 3;
using Machine = LinearMachine<kN, kC>;
using Belief = Machine::Belief;

/// Textbook Kalman filter with the constants as states without noise.
struct Textbook {
  static constexpr int kAll = kN + kC;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(kAll);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kAll, kAll);

  explicit Textbook(const Machine& m) {
    covariance.topLeftCorner<kN, kN>() = m.first;
    covariance.bottomRightCorner<kC, kC>() = m.prior.cwiseAbs2().asDiagonal();
  }
  void predict(const Machine& m) {
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kAll, kAll);
    F.topLeftCorner<kN, kN>() = m.F;
    F.topRightCorner<kN, kC>() = m.B;
    mean = F * mean;
    const Eigen::MatrixXd stepped = F * covariance;
    covariance = stepped * F.transpose();
    covariance.topLeftCorner<kN, kN>() += m.step_noise;
  }
  void correct(const Machine& m, double z) {
    Eigen::VectorXd seen(kAll);
    seen << m.H.transpose(), m.D.transpose();
    const Eigen::VectorXd shared = covariance * seen;
    const Eigen::VectorXd gain = shared / (seen.dot(shared) + m.noise);
    mean += gain * (z - seen.dot(mean));
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(kAll, kAll) - gain * seen.transpose();
    covariance = left * Eigen::MatrixXd(covariance);
  }
};

/// Friedland: the belief, with the constants fitted to its innovations, equals the filter that estimates both.
TEST(GaussianBelief, EqualsTheTextbookFilterWithGatheredConstants) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Machine machine(seed);
    const Machine::Run run = machine.run(seed + 100, 60);
    Belief belief = machine.begin();
    Machine::Vector mean = Machine::Vector::Zero();
    Eigen::Matrix3d information = machine.prior.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::Vector3d score = Eigen::Vector3d::Zero();
    Textbook textbook(machine);
    for (const double z : run.z) {
      machine.predict(belief, mean);
      const Belief::ConstantRow by_constant = machine.D - machine.H * belief.by_constant;
      const double variance = machine.innovationVariance(belief), innovation = machine.correct(belief, mean, z);
      information += by_constant.transpose() * by_constant / variance;
      score += by_constant.transpose() * innovation / variance;
      textbook.predict(machine);
      textbook.correct(machine, z);
      const Eigen::Matrix3d of_constants = information.inverse();
      const Eigen::Vector3d p = of_constants * score;
      EXPECT_TRUE((mean - belief.by_constant * p).isApprox(textbook.mean.head<kN>(), 1e-10));
      EXPECT_TRUE(p.isApprox(textbook.mean.tail<kC>(), 1e-10));
      EXPECT_TRUE(machine.grown(belief, of_constants).isApprox(textbook.covariance.topLeftCorner<kN, kN>(), 1e-10));
    }
  }
}

TEST(GaussianBelief, EqualsTheLastStateOfBatchLeastSquares) {
  Machine machine(7);
  machine.prior *= 0.1;
  const Machine::Run run = machine.run(8, 25);
  Belief belief = machine.begin();
  Machine::Vector mean = Machine::Vector::Zero();
  ConstantFit<kC> fit;
  fit.begin(machine.prior);
  for (const double z : run.z) {
    machine.predict(belief, mean);
    const Belief::ConstantRow by_constant = machine.D - machine.H * belief.by_constant;
    const double variance = machine.innovationVariance(belief), innovation = machine.correct(belief, mean, z);
    ASSERT_FALSE(exceeds(innovation, variance, gate::kRare));  // within the gate a fit is least squares
    fit.learn(innovation, variance, by_constant);
  }
  const Machine::Batch batch = machine.batch(run.z, machine.prior);
  const Eigen::Matrix3d of_constants = fit.covarianceOfFirst<kC>();
  const Eigen::Vector3d p = of_constants * fit.score();
  EXPECT_TRUE(p.isApprox(batch.p(), 1e-8)) << p << '\n' << batch.p();
  EXPECT_TRUE(of_constants.isApprox(batch.ofConstants(), 1e-8));
  EXPECT_TRUE((mean - belief.by_constant * p).isApprox(batch.x(25), 1e-8));
  EXPECT_TRUE(machine.grown(belief, of_constants).isApprox(batch.of(25), 1e-8));
}

/// Squared errors over their covariance (NEES) have the mean kN for machines whose constants are drawn from the prior.
/// The mean is larger where the constants are left out.
TEST(GaussianBelief, ErrorsOfDrawnMachinesHaveTheStatedSize) {
  const Machine machine(3);
  const Eigen::Matrix3d of_constants = machine.prior.cwiseAbs2().asDiagonal();
  constexpr int kRuns = 2000;
  double considered = 0.0, left_out = 0.0;
  for (unsigned r = 0; r < kRuns; ++r) {
    const Machine::Run run = machine.run(1000 + r, 12);
    Belief belief = machine.begin();
    Machine::Vector mean = Machine::Vector::Zero();
    for (const double z : run.z) machine.predict(belief, mean), machine.correct(belief, mean, z);
    const Machine::Vector error = run.x.back() - mean;
    considered += error.dot(machine.grown(belief, of_constants).llt().solve(error)) / kRuns;
    left_out += error.dot(belief.covariance.llt().solve(error)) / kRuns;
  }
  EXPECT_NEAR(considered, kN, 4.0 * std::sqrt(2.0 * kN / kRuns));  // 4 standard deviations of a mean of chi squares
  EXPECT_GT(left_out, 2.0 * kN);
}

TEST(GaussianBelief, TransitionOfFewRowsIsTheDenseOne) {
  const Machine machine(5);
  Belief few = machine.begin();
  few.by_constant = machine.B;
  Belief::Matrix f = Belief::Matrix::Identity();
  f.row(0) = machine.F.row(0), f.row(2) = machine.F.row(2);
  Eigen::Matrix<double, 2, kN> rows;
  rows << f.row(0), f.row(2);
  few.predict<0, 2>(rows);
  EXPECT_TRUE(few.covariance.isApprox(f * machine.first * f.transpose(), 1e-14));
  EXPECT_TRUE(few.by_constant.isApprox(f * machine.B, 1e-14));
  EXPECT_EQ(few.covariance, few.covariance.transpose());
}

/// A dense Schmidt filter on all variables has equal gains. Its gain for the constants is zero.
TEST(GaussianBelief, WeighsAMeasurementByConstantsThatAreConsidered) {
  constexpr int kAll = kN + kC;
  using Dense = Eigen::Matrix<double, kAll, kAll>;
  Machine machine(9);
  machine.H = Belief::Row::Unit(1);
  const Belief::ConstantRow of_constants = machine.prior.cwiseAbs2().transpose();
  Belief belief = machine.begin();
  Dense both = Dense::Identity();  // covariance of the errors of (x, p)
  both.topLeftCorner<kN, kN>() = machine.first;
  both.bottomRightCorner<kC, kC>() = machine.prior.cwiseAbs2().asDiagonal();
  Machine::Vector mean = Machine::Vector::Zero();
  Dense step = Dense::Identity();
  step.topLeftCorner<kN, kN>() = machine.F, step.topRightCorner<kN, kC>() = machine.B;
  Eigen::Matrix<double, 1, kAll> seen;
  seen << machine.H, machine.D;
  for (int k = 0; k < 20; ++k) {
    machine.predict(belief, mean);
    const Belief::Vector gain = belief.correct(1, machine.noise, machine.D, of_constants);
    both = (step * both * step.transpose()).eval();
    both.topLeftCorner<kN, kN>() += machine.step_noise;
    Eigen::Matrix<double, kAll, 1> of_all = both * seen.transpose() / (seen * both * seen.transpose() + machine.noise);
    of_all.tail<kC>().setZero();
    const Dense left = Dense::Identity() - of_all * seen;
    both = (left * both * left.transpose() + machine.noise * of_all * of_all.transpose()).eval();
    EXPECT_TRUE(gain.isApprox(of_all.head<kN>(), 1e-10)) << k;
    EXPECT_TRUE(machine.grown(belief, of_constants.asDiagonal()).isApprox(both.topLeftCorner<kN, kN>(), 1e-10)) << k;
  }
  Belief plain = machine.begin(), weighed = plain;  // zero variances: as without constants
  EXPECT_TRUE(
      plain.correct(2, 0.3, machine.D)
          .isApprox(weighed.correct(2, 0.3, machine.D, Belief::ConstantRow(Belief::ConstantRow::Zero())), 1e-14));
  EXPECT_TRUE(weighed.covariance.isApprox(plain.covariance, 1e-13));
}

/// A reading with a variance of 1e-12 rad2 meets a torque of 1e6 N m and two variables that are equal up to a part in
/// 1e12. No variance becomes negative, and the final variance is that of all samples.
TEST(GaussianBelief, SurvivesExactReadingsOfBadlyScaledVariables) {
  GaussianBelief<3, 1> belief;
  belief.covariance << 1e6, 1e6, 1e9, 1e6, 1e6 * (1.0 + 1e-12), 1e9, 1e9, 1e9, 1e12 + 1.0;
  constexpr double kNoise = 1e-12;
  for (int i = 1; i <= 1000; ++i) {
    belief.correct(i % 2, kNoise, GaussianBelief<3, 1>::ConstantRow::Zero());
    ASSERT_TRUE(belief.isSound()) << i;
    ASSERT_LE(belief.covariance(i % 2, i % 2), kNoise);
  }
  // The first variable has 500 readings. Its twin, with a standard deviation of 1e-3 from it, adds almost nothing.
  EXPECT_NEAR(belief.covariance(0, 0), kNoise / 500.0, 1e-3 * kNoise / 500.0);
}

TEST(GaussianBelief, DrawsDecouplesAndWidens) {
  const Machine machine(9);
  Belief belief = machine.begin();
  belief.by_constant = machine.B;
  const Belief before = belief;

  belief.decouple(1);
  EXPECT_EQ(belief.covariance(1, 1), before.covariance(1, 1));
  EXPECT_EQ(belief.covariance.row(1).norm(), before.covariance(1, 1));
  EXPECT_EQ(belief.by_constant, before.by_constant);
  const double of_one = belief.covariance(1, 1);
  belief.correct(0, 0.1, Belief::ConstantRow::Zero());
  EXPECT_EQ(belief.covariance(1, 1), of_one);

  belief.draw(2, 5.0, machine.D);
  EXPECT_EQ(belief.covariance(2, 2), 5.0);
  EXPECT_EQ(belief.covariance.row(2).norm(), 5.0);
  EXPECT_EQ(belief.by_constant.row(2), machine.D);

  Belief wide = before;
  wide.widen({2.0, 1.0, 1.0, 3.0});
  EXPECT_EQ(wide.covariance(0, 0), 4.0 * before.covariance(0, 0));
  EXPECT_DOUBLE_EQ(wide.covariance(0, 3), 6.0 * before.covariance(0, 3));
  EXPECT_EQ(wide.covariance(1, 2), before.covariance(1, 2));
}

TEST(ConstantFit, FadesUpdatesAndBoundsTheEffectOfOneInnovation) {
  ConstantFit<1> fit;
  using Row = ConstantFit<1>::Row;
  fit.begin(ConstantFit<1>::Vector(10.0));
  fit.learn(2.0, 1.0, Row(1.0));
  EXPECT_DOUBLE_EQ(fit.score()[0], 2.0);
  fit.learn(300.0, 1.0, Row(1.0));  // a hundred times the gate: 9/90000 of a reading
  EXPECT_DOUBLE_EQ(fit.score()[0], 2.0 + 0.03);
  EXPECT_DOUBLE_EQ(fit.information()(0, 0), 0.01 + 1.0 + 1e-4);
  fit.fade(0.5);
  EXPECT_DOUBLE_EQ(fit.score()[0], 1.015);
  const double before = fit.score()[0] / fit.information()(0, 0);
  fit.shift(0, -before);  // the constant now has its estimated value
  EXPECT_NEAR(fit.score()[0], 0.0, 1e-15);
}

}  // namespace
}  // namespace hammer_loads::test
