/// Linear systems whose matrix is symmetric and positive, of any size.
#pragma once

#include <Eigen/Core>

namespace hammer_loads::calibration {

/// The x of matrix x = right, for each column of it. Compiled once: a solver of its own for each size is slow to build
/// and no faster here.
Eigen::MatrixXd solved(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix);

}  // namespace hammer_loads::calibration
