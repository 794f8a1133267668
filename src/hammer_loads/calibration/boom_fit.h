/// Maximum a posteriori estimate of a boom's unknowns from its cylinders' forces in free movement: readings, residuals
/// of the model and fit.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads::calibration {

/// Force of one cylinder at a point where the sign of the rod speed is certain.
struct BoomRow {
  std::size_t recording{}, cylinder{};
  const BoomPoint* point{};
  double measured{};  ///< force [N]
};

/// Returns the rows of all recordings, ordered by recording, cylinder and time. The points must outlive the rows.
std::vector<BoomRow> rowsOf(const BoomModel& model, const std::vector<BoomPoints>& recordings);

/// Returns the residuals: measured forces of the rows minus the model's forces at x [N].
Eigen::VectorXd residualsOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x);

/// Returns the derivatives of the model's forces by the unknowns at x [N].
Eigen::MatrixXd slopesOf(const BoomModel& model, const std::vector<BoomRow>& rows, const Eigen::VectorXd& x);

struct BoomFit {
  Eigen::VectorXd x;             ///< values in the order of BoomModel, in prior standard deviations
  Eigen::MatrixXd covariance;    ///< covariance of x
  std::vector<double> noise;     ///< per cylinder: standard deviation of a row's residual [N]
  std::vector<double> together;  ///< per cylinder: number of successive rows with the information of one, >= 1 [-]
  bool converged{};
};

/// Fits by Gauss-Newton the squared residuals and unknowns over their variances, with Huber weights beyond three
/// deviations. The noise of each cylinder is that of its residuals. Correlation of neighbouring residuals reduces their
/// effective number. Friction is not negative.
BoomFit fitBoom(const BoomModel& model, const std::vector<BoomRow>& rows, const Progress& progress = {});

/// Linear system of a fit about its values.
struct BoomSystem {
  Eigen::VectorXd left;    ///< residuals [N]; zero where the model has no force
  Eigen::VectorXd weight;  ///< from noise, correlation of neighbours and Huber weights [1/N2]
  Eigen::MatrixXd slopes;  ///< derivatives of the model's forces by the unknowns [N]
  Eigen::MatrixXd information() const { return slopes.transpose() * weight.asDiagonal() * slopes; }
};
BoomSystem systemOf(const BoomModel& model, const std::vector<BoomRow>& rows, const BoomFit& fit);

/// Returns the standard deviations of a function of the unknowns, by differences of 0.1 prior deviations.
Eigen::VectorXd stdsOf(const BoomFit& fit, const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& function);

}  // namespace hammer_loads::calibration
