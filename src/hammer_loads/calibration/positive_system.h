/// Linear systems of any size with a symmetric, positive matrix.
#pragma once

#include <Eigen/Core>

namespace hammer_loads::calibration {

/// Solves matrix x = right for each column of right. It is compiled once: a separate solver for each size is slow to
/// build and no faster here.
Eigen::MatrixXd solved(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix);

}  // namespace hammer_loads::calibration
