/// What a Kalman filter does with its covariance at each reading, and what a covariance makes of loads, as fast as the
/// processor can.
#pragma once

#include <array>

namespace hammer_loads {

/// A square block on the diagonal of a matrix stored by columns: rows and columns from `first` up to `last`; these and
/// every other index here are multiples of four.
struct CovarianceBlock {
  double* values{};  ///< of the whole matrix
  int stride{};      ///< from column to column
  int first{}, last{};
};

constexpr int kMostAtOnce = 3;  ///< rows or columns that are worked on in one pass over a matrix

/// P row^T of each of up to kMostAtOnce rows, stored one after the other, each of P's stride, as the results are. A row
/// is zero before `begin`, but for a one at unit, any index that is less.
void timesRows(const CovarianceBlock& P, int count, const double* rows, int begin, const int* unit,
               double* results) noexcept;

/// P <- P - sum column column^T/S, of up to kMostAtOnce columns, stored likewise.
void subtractSquares(const CovarianceBlock& P, int count, const double* columns, const double* S) noexcept;

/// P <- F P F^T, where F makes two states, `first` and the one after it, of five states that hold both of them.
void replaceTwo(const CovarianceBlock& P, int first, const std::array<int, 5>& of, const std::array<double, 5>& by_one,
                const std::array<double, 5>& by_other) noexcept;

/// Loads that are linear in some inputs, in fours: of each four loads what the first input does to them, then what the
/// second does, and so on. Zeros fill up the last four.
struct LinearLoads {
  const double* fours{};
  int loads{}, inputs{};
};
constexpr int kUsualInputs = 6;  ///< compiled for: three cylinders and a load in the boom's plane

/// Of each load, and what fills up the last four, the variance by a covariance of the inputs: its diagonal and what is
/// below, stored by columns of a stride. Where rounding would make it negative it is zero.
void findVariances(const LinearLoads& loads, const double* covariance, int stride, double* variance) noexcept;

/// Adds of each load the larger of the squares of what two vectors of inputs make of it.
void addLargerSquare(const LinearLoads& loads, const double* one, const double* other, double* variance) noexcept;

}  // namespace hammer_loads
