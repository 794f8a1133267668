/// The most probable values of a boom's unknowns, from what its cylinders showed in free movement.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// One cylinder at one point, where its rod surely moves one way.
struct BoomRow {
  std::size_t recording{}, cylinder{};
  const BoomPoint* point{};
  double measured{};  ///< force [N]
};

/// Rows of the points of all recordings, in the order of recordings, cylinders, times. The points must outlive the
/// rows.
std::vector<BoomRow> rowsOf(const BoomModel& model, const std::vector<BoomPoints>& recordings);

struct BoomFit {
  Eigen::VectorXd x;             ///< values in the order of BoomModel, in standard deviations before the recording
  Eigen::MatrixXd covariance;    ///< covariance of x
  std::vector<double> noise;     ///< per cylinder: standard deviation of what is left of a row [N]
  std::vector<double> together;  ///< per cylinder: this many rows in a row say as much as one, >= 1 [-]
  bool converged{};
};

/// Gauss-Newton on squares of what is left and of the unknowns, each over its variance; what is left is large where it
/// is beyond three deviations, and counts less (Huber). Noise is that of what is left, per cylinder, and what is left
/// of neighbours may be alike: then this many of them count as one. Friction is not below zero.
BoomFit fitBoom(const BoomModel& model, const std::vector<BoomRow>& rows, const Progress& progress = {});

/// Residuals: forces of the rows less those of the model with values x [N].
Eigen::VectorXd residualsOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x);

/// Standard deviation of any function of x; by differences over a tenth of each unknown's deviation.
template <typename Function>
Eigen::VectorXd gradientOf(const Function& function, const Eigen::VectorXd& x) {
  constexpr double kStep = 0.1;
  Eigen::VectorXd gradient(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd up = x, down = x;
    up[i] += kStep, down[i] -= kStep;
    gradient[i] = (function(up) - function(down)) / (2.0 * kStep);
  }
  return gradient;
}

}  // namespace hammer_loads::calibration
