/// Maximum a posteriori estimate of a boom's unknowns from its cylinders' forces in free movement.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/boom_rows.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

struct BoomFit {
  Eigen::VectorXd x;             ///< values in the order of BoomModel, in standard deviations before the recording
  Eigen::MatrixXd covariance;    ///< covariance of x
  std::vector<double> noise;     ///< per cylinder: standard deviation of a row's residual [N]
  std::vector<double> together;  ///< per cylinder: number of successive rows that give the information of one, >= 1 [-]
  bool converged{};
};

/// Gauss-Newton on the squares of residuals and unknowns over their variances, with Huber weights beyond three
/// deviations. The noise is that of the residuals, per cylinder. Residuals of neighbours may be correlated; their
/// number is then reduced accordingly. Friction is not negative.
BoomFit fitBoom(const BoomModel& model, const std::vector<BoomRow>& rows, const Progress& progress = {});

/// Weights of rows with these residuals in a fit [1/N2]: the noise, the correlation of neighbours, Huber's weights.
Eigen::VectorXd weightsOf(const BoomFit& fit, const std::vector<BoomRow>& rows, const Eigen::VectorXd& left);

/// Gradient of any function of x; by differences over a tenth of each unknown's deviation.
template <typename Function>
Eigen::VectorXd gradientOf(const Function& function, const Eigen::VectorXd& x) {
  constexpr double kStep = 0.1;  // Numerical: kStep
  Eigen::VectorXd gradient(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd up = x, down = x;
    up[i] += kStep, down[i] -= kStep;
    gradient[i] = (function(up) - function(down)) / (2.0 * kStep);
  }
  return gradient;
}

}  // namespace hammer_loads::calibration
