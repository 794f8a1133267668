/// Maximum a posteriori estimate of a boom's unknowns from its cylinders' forces in free movement: readings, the
/// model's errors at them, and the fit.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// Reading of one cylinder at one point with a rod speed of certain sign.
struct BoomRow {
  std::size_t recording{}, cylinder{};
  const BoomPoint* point{};
  double measured{};  ///< force [N]
};

/// Rows of the points of all recordings, in the order of recordings, cylinders, times. The points must outlive the
/// rows.
std::vector<BoomRow> rowsOf(const BoomModel& model, const std::vector<BoomPoints>& recordings);

/// Residuals: forces of the rows less those of the model with values x [N].
Eigen::VectorXd residualsOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x);

/// Slopes of the model's forces by the unknowns at x [N].
Eigen::MatrixXd slopesOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x);

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

/// Linear system of a fit about its values.
struct BoomSystem {
  Eigen::VectorXd left;    ///< residuals [N]; zero where the model has no force
  Eigen::VectorXd weight;  ///< the noise, the correlation of neighbours, Huber's weights [1/N2]
  Eigen::MatrixXd slopes;  ///< derivatives of the model's forces by the unknowns [N]
  Eigen::MatrixXd information() const { return slopes.transpose() * weight.asDiagonal() * slopes; }
};
BoomSystem systemOf(const BoomModel& model, const std::vector<BoomRow>& rows, const BoomFit& fit);

/// Standard deviations of a function of the unknowns, by differences over a tenth of each unknown's deviation.
Eigen::VectorXd stdsOf(const BoomFit& fit, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& function);

}  // namespace hammer_loads::calibration
