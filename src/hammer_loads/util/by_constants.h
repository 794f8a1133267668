/// Derivatives of some numbers by many constants.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

/// A row is a number, a column a constant. A row is contiguous, so that a loop over the constants is vectorised. Single
/// precision is enough for standard deviations and takes half the instructions.
template <int numbers, int constants, typename Scalar = float>
using ByConstants =
    Eigen::Matrix<Scalar, numbers, constants, constants == 1 && numbers != 1 ? Eigen::ColMajor : Eigen::RowMajor>;

}  // namespace hammer_loads
