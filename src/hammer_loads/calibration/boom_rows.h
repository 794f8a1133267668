/// Readings of the cylinders that a boom is fitted to, and the model's errors at them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"

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

}  // namespace hammer_loads::calibration
