// Random linear machine, its simulated runs, and batch least squares for all its states and constants.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "hammer_loads/estimation/gaussian_belief.h"

namespace hammer_loads::test {

/// x' = F x + B p + w, z = H x + D p + v.
template <int N, int C>
struct LinearMachine {
  using Belief = GaussianBelief<N, C, double>;
  using Vector = typename Belief::Vector;
  using Constants = Eigen::Matrix<double, C, 1>;
  using ConstantMatrix = Eigen::Matrix<double, C, C>;

  typename Belief::Matrix F, step_noise, first;  ///< covariances of w and of the first x
  typename Belief::Effect B;
  typename Belief::Row H;
  typename Belief::ConstantRow D;
  double noise{};   ///< variance of v
  Constants prior;  ///< standard deviations of p, whose mean is 0

  explicit LinearMachine(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto fill = [&](auto& m) {
      for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = any(random);
    };
    fill(F), fill(B), fill(H), fill(D);
    F *= 0.9 / F.norm(), F.diagonal().array() += 0.3;
    Eigen::Matrix<double, N, N> root;
    fill(root), step_noise = 0.1 * root * root.transpose();
    fill(root), first = root * root.transpose() + Belief::Matrix::Identity();
    noise = 0.3;
    prior = Constants::LinSpaced(0.5, 1.5);
  }

  Belief begin() const {
    Belief belief;
    belief.covariance = first;
    return belief;
  }
  void predict(Belief& belief, Vector& mean) const {
    belief.covariance = (F * belief.covariance * F.transpose()).eval();
    belief.by_constant = (F * belief.by_constant - B).eval();  // the mean lacks the effect of p
    for (Eigen::Index i = 0; i < N; ++i)
      for (Eigen::Index k = i; k < N; ++k) belief.addNoise(i, k, step_noise(i, k));
    mean = (F * mean).eval();
  }
  /// Corrects by a reading. Returns the innovation.
  double correct(Belief& belief, Vector& mean, double z) const {
    const double innovation = z - H.dot(mean);
    mean += belief.correct(H, noise, D) * innovation;
    return innovation;
  }
  /// Returns the covariance of the variables for a given one of the constants.
  static typename Belief::Matrix grown(const Belief& belief, const ConstantMatrix& of_constants) {
    return belief.covariance + belief.by_constant * of_constants * belief.by_constant.transpose();
  }
  double innovationVariance(const Belief& belief) const { return H * belief.covariance * H.transpose() + noise; }

  struct Run {
    Constants p;
    std::vector<Vector> x;  ///< [0] is the state before the first step
    std::vector<double> z;  ///< [k] is the reading of x[k + 1]
  };
  Run run(unsigned seed, int steps) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto white = [&](Eigen::Index) { return normal(random); };
    const auto draw = [&](const auto& covariance) {
      return Vector(covariance.llt().matrixL() * Vector::NullaryExpr(white));
    };
    Run run;
    run.p = Constants::NullaryExpr(white).cwiseProduct(prior);
    run.x.push_back(draw(first));
    for (int k = 0; k < steps; ++k) {
      run.x.push_back(F * run.x.back() + B * run.p + draw(step_noise));
      run.z.push_back(H.dot(run.x.back()) + D.dot(run.p) + std::sqrt(noise) * normal(random));
    }
    return run;
  }

  struct Batch {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    Vector x(int k) const { return mean.segment<N>(N * k); }
    typename Belief::Matrix of(int k) const { return covariance.block<N, N>(N * k, N * k); }
    Constants p() const { return mean.tail<C>(); }
    ConstantMatrix ofConstants() const { return covariance.bottomRightCorner<C, C>(); }
  };
  /// Estimates all x and p from all z by the normal equations. deviations: prior standard deviations of p.
  Batch batch(const std::vector<double>& z, const Constants& deviations) const {
    const Eigen::Index n = N * static_cast<Eigen::Index>(z.size() + 1) + C;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd score = Eigen::VectorXd::Zero(n);
    information.topLeftCorner(N, N) = first.inverse();
    const Constants weight = deviations.cwiseAbs2().cwiseInverse();
    information.bottomRightCorner(C, C) = weight.asDiagonal();
    const Eigen::MatrixXd of_step = step_noise.inverse();
    for (std::size_t k = 0; k < z.size(); ++k) {
      const Eigen::Index at = N * static_cast<Eigen::Index>(k);
      Eigen::MatrixXd off = Eigen::MatrixXd::Zero(N, n);
      off.block(0, at + N, N, N).setIdentity();
      off.block(0, at, N, N) = -F;
      off.rightCols(C) = -B;
      const Eigen::MatrixXd weighed = of_step * off;
      information += off.transpose() * weighed;
      Eigen::VectorXd seen = Eigen::VectorXd::Zero(n);
      seen.segment(at + N, N) = H;
      seen.tail(C) = D;
      information += seen * seen.transpose() / noise;
      score += z[k] / noise * seen;
    }
    const Eigen::MatrixXd covariance = information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    return {covariance * score, covariance};
  }
};

}  // namespace hammer_loads::test
