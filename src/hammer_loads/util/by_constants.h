/// Derivatives of some numbers by many constants.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

/// A row a number, a column a constant; a row lies in one piece: there are many more constants than numbers, and a loop
/// over those is what the compiler makes two or four at a time.
template <int numbers, int constants>
using ByConstants =
    Eigen::Matrix<double, numbers, constants, constants == 1 && numbers != 1 ? Eigen::ColMajor : Eigen::RowMajor>;

}  // namespace hammer_loads
