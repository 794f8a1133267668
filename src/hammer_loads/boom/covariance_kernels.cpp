#include "hammer_loads/boom/covariance_kernels.h"

#include <limits>

#include "hammer_loads/boom/lanes.h"
#include "hammer_loads/util/avx2.h"

namespace hammer_loads {
namespace {

constexpr int kLane = 4;

// Blocks by value, counts as constants: else each store would make the compiler read them again.

template <int count>
HAMMER_LOADS_INLINE void timesRowsOf(CovarianceBlock P, const double* rows, int begin, const int* unit,
                                     double* results) noexcept {
  for (int i = P.first; i < P.last; i += kLane) {
    Lanes sum[count];
    for (int k = 0; k < count; ++k) sum[k] = lanesAt(P.values + unit[k] * P.stride + i);
    const double* column = P.values + begin * P.stride + i;
    for (int j = begin; j < P.last; ++j, column += P.stride) {
      const Lanes value = lanesAt(column);
      for (int k = 0; k < count; ++k) sum[k] += rows[k * P.stride + j] * value;
    }
    for (int k = 0; k < count; ++k) store(sum[k], results + k * P.stride + i);
  }
}

template <int count>
HAMMER_LOADS_INLINE void subtractSquaresOf(CovarianceBlock P, const double* columns, const double* S) noexcept {
  double minus[count];
  for (int k = 0; k < count; ++k) minus[k] = -1.0 / S[k];
  for (int i = P.first; i < P.last; i += kLane) {
    Lanes gain[count];
    for (int k = 0; k < count; ++k) gain[k] = minus[k] * lanesAt(columns + k * P.stride + i);
    double* changed = P.values + P.first * P.stride + i;
    for (int j = P.first; j < P.last; ++j, changed += P.stride) {
      Lanes value = lanesAt(changed);
      for (int k = 0; k < count; ++k) value += gain[k] * columns[k * P.stride + j];
      store(value, changed);
    }
  }
}

HAMMER_LOADS_INLINE void timesRowsAny(const CovarianceBlock& P, int count, const double* rows, int begin,
                                      const int* unit, double* results) noexcept {
  if (count == 3) return timesRowsOf<3>(P, rows, begin, unit, results);
  if (count == 2) return timesRowsOf<2>(P, rows, begin, unit, results);
  timesRowsOf<1>(P, rows, begin, unit, results);
}

HAMMER_LOADS_INLINE void subtractSquaresAny(const CovarianceBlock& P, int count, const double* columns,
                                            const double* S) noexcept {
  if (count == 3) return subtractSquaresOf<3>(P, columns, S);
  if (count == 2) return subtractSquaresOf<2>(P, columns, S);
  subtractSquaresOf<1>(P, columns, S);
}

HAMMER_LOADS_INLINE void replaceTwoAny(CovarianceBlock P, int first, const int* of, const double* by_one,
                                       const double* by_other) noexcept {
  const double* from[5];
  for (int k = 0; k < 5; ++k) from[k] = P.values + of[k] * P.stride;
  double *one = P.values + first * P.stride, *other = one + P.stride;
  for (int i = P.first; i < P.last; i += kLane) {
    Lanes sum_one{}, sum_other{};
#pragma GCC unroll 5
    for (int k = 0; k < 5; ++k) {
      const Lanes value = lanesAt(from[k] + i);
      sum_one += by_one[k] * value, sum_other += by_other[k] * value;
    }
    store(sum_one, one + i), store(sum_other, other + i);
  }
  // P F^T so far. The two states' own block needs the rows as well; then rows are what columns are.
  double own[2][2]{};
  for (int k = 0; k < 5; ++k) {
    own[0][0] += by_one[k] * one[of[k]], own[1][1] += by_other[k] * other[of[k]];
    own[0][1] += by_one[k] * other[of[k]], own[1][0] += by_other[k] * one[of[k]];
  }
  one[first] = own[0][0], other[first + 1] = own[1][1];
  one[first + 1] = other[first] = 0.5 * (own[0][1] + own[1][0]);
  for (int j = P.first; j < P.last; ++j) {
    double* row = P.values + j * P.stride + first;
    row[0] = one[j], row[1] = other[j];
  }
}

/// most: of inputs, a constant.
template <int most>
HAMMER_LOADS_INLINE void findVariancesUpTo(LinearLoads loads, const double* covariance, int stride,
                                           double* variance) noexcept {
  const double* by_input = loads.fours;
  for (int load = 0; load < loads.loads; load += kLane, by_input += kLane * loads.inputs) {
    Lanes half{};
#pragma GCC unroll 6
    for (int k = 0; k < most; ++k) {
      if (most != kUsualInputs && k >= loads.inputs) break;
      const double* column = covariance + k * stride;
      const Lanes by = lanesAt(by_input + kLane * k);
      Lanes with = 0.5 * column[k] * by;
#pragma GCC unroll 6
      for (int i = 0; i < most; ++i) {
        if (most != kUsualInputs && i >= loads.inputs) break;
        if (i > k) with += column[i] * lanesAt(by_input + kLane * i);
      }
      half += by * with;
    }
    store(half < 0.0 ? Lanes{} : 2.0 * half, variance + load);
  }
}

HAMMER_LOADS_INLINE void findVariancesAny(const LinearLoads& loads, const double* covariance, int stride,
                                          double* variance) noexcept {
  if (loads.inputs == kUsualInputs) return findVariancesUpTo<kUsualInputs>(loads, covariance, stride, variance);
  findVariancesUpTo<std::numeric_limits<int>::max()>(loads, covariance, stride, variance);
}

HAMMER_LOADS_INLINE void addLargerSquareAny(LinearLoads loads, const double* one, const double* other,
                                            double* variance) noexcept {
  const double* by_input = loads.fours;
  for (int load = 0; load < loads.loads; load += kLane) {
    Lanes by_one{}, by_other{};
    for (int i = 0; i < loads.inputs; ++i, by_input += kLane) {
      const Lanes by = lanesAt(by_input);
      by_one += one[i] * by, by_other += other[i] * by;
    }
    by_one *= by_one, by_other *= by_other;
    store(lanesAt(variance + load) + (by_one > by_other ? by_one : by_other), variance + load);
  }
}

HAMMER_LOADS_AVX2 void timesRowsAvx2(const CovarianceBlock& P, int count, const double* rows, int begin,
                                     const int* unit, double* results) noexcept {
  timesRowsAny(P, count, rows, begin, unit, results);
}
HAMMER_LOADS_AVX2 void subtractSquaresAvx2(const CovarianceBlock& P, int count, const double* columns,
                                           const double* S) noexcept {
  subtractSquaresAny(P, count, columns, S);
}
HAMMER_LOADS_AVX2 void replaceTwoAvx2(const CovarianceBlock& P, int first, const int* of, const double* by_one,
                                      const double* by_other) noexcept {
  replaceTwoAny(P, first, of, by_one, by_other);
}
HAMMER_LOADS_AVX2 void findVariancesAvx2(const LinearLoads& loads, const double* covariance, int stride,
                                         double* variance) noexcept {
  findVariancesAny(loads, covariance, stride, variance);
}
HAMMER_LOADS_AVX2 void addLargerSquareAvx2(const LinearLoads& loads, const double* one, const double* other,
                                           double* variance) noexcept {
  addLargerSquareAny(loads, one, other, variance);
}

}  // namespace

void timesRows(const CovarianceBlock& P, int count, const double* rows, int begin, const int* unit,
               double* results) noexcept {
  if (kHasAvx2) return timesRowsAvx2(P, count, rows, begin, unit, results);
  timesRowsAny(P, count, rows, begin, unit, results);
}

void subtractSquares(const CovarianceBlock& P, int count, const double* columns, const double* S) noexcept {
  if (kHasAvx2) return subtractSquaresAvx2(P, count, columns, S);
  subtractSquaresAny(P, count, columns, S);
}

void replaceTwo(const CovarianceBlock& P, int first, const std::array<int, 5>& of, const std::array<double, 5>& by_one,
                const std::array<double, 5>& by_other) noexcept {
  if (kHasAvx2) return replaceTwoAvx2(P, first, of.data(), by_one.data(), by_other.data());
  replaceTwoAny(P, first, of.data(), by_one.data(), by_other.data());
}

void findVariances(const LinearLoads& loads, const double* covariance, int stride, double* variance) noexcept {
  if (kHasAvx2) return findVariancesAvx2(loads, covariance, stride, variance);
  findVariancesAny(loads, covariance, stride, variance);
}

void addLargerSquare(const LinearLoads& loads, const double* one, const double* other, double* variance) noexcept {
  if (kHasAvx2) return addLargerSquareAvx2(loads, one, other, variance);
  addLargerSquareAny(loads, one, other, variance);
}

}  // namespace hammer_loads
