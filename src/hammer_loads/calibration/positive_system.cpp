#include "hammer_loads/calibration/positive_system.h"

#include <Eigen/Cholesky>

namespace hammer_loads::calibration {

Eigen::MatrixXd solved(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix) {
  return solved(matrix, Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

}  // namespace hammer_loads::calibration
