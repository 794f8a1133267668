#include "hammer_loads/boom/covariance_kernels.h"

#include <limits>

#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

constexpr int kLane = 4;
/// Four numbers: two registers of any x86-64, one of most. Without fused multiply-add, so that both give the same bits.
typedef double Lane __attribute__((vector_size(kLane * sizeof(double)), aligned(sizeof(double)), may_alias));

HAMMER_LOADS_INLINE const Lane& laneAt(const double* values) noexcept { return *reinterpret_cast<const Lane*>(values); }
HAMMER_LOADS_INLINE Lane& laneAt(double* values) noexcept { return *reinterpret_cast<Lane*>(values); }

// Arguments by value and in full lanes of columns: else each store would make the compiler read them again.

HAMMER_LOADS_INLINE void timesRowAny(CovarianceBlock P, const double* row, int begin, int unit,
                                     double* result) noexcept {
  for (int i = P.first; i < P.last; i += kLane) {
    Lane sum = laneAt(P.values + unit * P.stride + i);
    const double* column = P.values + begin * P.stride + i;
    for (int j = begin; j < P.last; j += kLane) {
#pragma GCC unroll 4
      for (int k = 0; k < kLane; ++k, column += P.stride) sum += row[j + k] * laneAt(column);
    }
    laneAt(result + i) = sum;
  }
}

HAMMER_LOADS_INLINE void subtractSquareAny(CovarianceBlock P, const double* column, double S) noexcept {
  const double minus = -1.0 / S;
  for (int i = P.first; i < P.last; i += kLane) {
    const Lane gain = minus * laneAt(column + i);
    double* changed = P.values + P.first * P.stride + i;
    for (int j = P.first; j < P.last; j += kLane) {
#pragma GCC unroll 4
      for (int k = 0; k < kLane; ++k, changed += P.stride) laneAt(changed) += gain * column[j + k];
    }
  }
}

HAMMER_LOADS_INLINE void replaceTwoAny(CovarianceBlock P, int first, const int* of, const double* by_one,
                                       const double* by_other) noexcept {
  const double* from[5];
  for (int k = 0; k < 5; ++k) from[k] = P.values + of[k] * P.stride;
  double *one = P.values + first * P.stride, *other = one + P.stride;
  for (int i = P.first; i < P.last; i += kLane) {
    Lane sum_one{}, sum_other{};
#pragma GCC unroll 5
    for (int k = 0; k < 5; ++k) {
      const Lane value = laneAt(from[k] + i);
      sum_one += by_one[k] * value, sum_other += by_other[k] * value;
    }
    laneAt(one + i) = sum_one, laneAt(other + i) = sum_other;
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
HAMMER_LOADS_INLINE void sumOfSquaresUpTo(LinearLoads loads, const double* root, int root_stride,
                                          double* sum) noexcept {
  const double* by_input = loads.fours;
  for (int load = 0; load < loads.loads; load += kLane, by_input += kLane * loads.inputs) {
    Lane all{};
#pragma GCC unroll 6
    for (int k = 0; k < most; ++k) {
      if (most != kUsualInputs && k >= loads.inputs) break;
      Lane one{};
#pragma GCC unroll 6
      for (int i = 0; i < most; ++i) {
        if (most != kUsualInputs && i >= loads.inputs) break;
        if (i >= k) one += root[k * root_stride + i] * laneAt(by_input + kLane * i);
      }
      all += one * one;
    }
    laneAt(sum + load) = all;
  }
}

HAMMER_LOADS_INLINE void sumOfSquaresAny(const LinearLoads& loads, const double* root, int root_stride,
                                         double* sum) noexcept {
  if (loads.inputs == kUsualInputs) return sumOfSquaresUpTo<kUsualInputs>(loads, root, root_stride, sum);
  sumOfSquaresUpTo<std::numeric_limits<int>::max()>(loads, root, root_stride, sum);
}

HAMMER_LOADS_INLINE void addLargerSquareAny(LinearLoads loads, const double* one, const double* other,
                                            double* sum) noexcept {
  const double* by_input = loads.fours;
  for (int load = 0; load < loads.loads; load += kLane) {
    Lane by_one{}, by_other{};
    for (int i = 0; i < loads.inputs; ++i, by_input += kLane) {
      const Lane by = laneAt(by_input);
      by_one += one[i] * by, by_other += other[i] * by;
    }
    by_one *= by_one, by_other *= by_other;
    laneAt(sum + load) += by_one > by_other ? by_one : by_other;
  }
}

#if defined(__x86_64__) && defined(__GNUC__)
const bool kHasAvx2 = [] {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") != 0;
}();
#define HAMMER_LOADS_AVX2 [[gnu::target("avx2")]]
#else
constexpr bool kHasAvx2 = false;
#define HAMMER_LOADS_AVX2
#endif

HAMMER_LOADS_AVX2 void timesRowAvx2(const CovarianceBlock& P, const double* row, int begin, int unit,
                                    double* result) noexcept {
  timesRowAny(P, row, begin, unit, result);
}
HAMMER_LOADS_AVX2 void subtractSquareAvx2(const CovarianceBlock& P, const double* column, double S) noexcept {
  subtractSquareAny(P, column, S);
}
HAMMER_LOADS_AVX2 void replaceTwoAvx2(const CovarianceBlock& P, int first, const int* of, const double* by_one,
                                      const double* by_other) noexcept {
  replaceTwoAny(P, first, of, by_one, by_other);
}
HAMMER_LOADS_AVX2 void sumOfSquaresAvx2(const LinearLoads& loads, const double* root, int root_stride,
                                        double* sum) noexcept {
  sumOfSquaresAny(loads, root, root_stride, sum);
}
HAMMER_LOADS_AVX2 void addLargerSquareAvx2(const LinearLoads& loads, const double* one, const double* other,
                                           double* sum) noexcept {
  addLargerSquareAny(loads, one, other, sum);
}

}  // namespace

void timesRow(const CovarianceBlock& P, const double* row, int begin, int unit, double* result) noexcept {
  if (kHasAvx2) return timesRowAvx2(P, row, begin, unit, result);
  timesRowAny(P, row, begin, unit, result);
}

void subtractSquare(const CovarianceBlock& P, const double* column, double S) noexcept {
  if (kHasAvx2) return subtractSquareAvx2(P, column, S);
  subtractSquareAny(P, column, S);
}

void replaceTwo(const CovarianceBlock& P, int first, const std::array<int, 5>& of, const std::array<double, 5>& by_one,
                const std::array<double, 5>& by_other) noexcept {
  if (kHasAvx2) return replaceTwoAvx2(P, first, of.data(), by_one.data(), by_other.data());
  replaceTwoAny(P, first, of.data(), by_one.data(), by_other.data());
}

void sumOfSquares(const LinearLoads& loads, const double* root, int root_stride, double* sum) noexcept {
  if (kHasAvx2) return sumOfSquaresAvx2(loads, root, root_stride, sum);
  sumOfSquaresAny(loads, root, root_stride, sum);
}

void addLargerSquare(const LinearLoads& loads, const double* one, const double* other, double* sum) noexcept {
  if (kHasAvx2) return addLargerSquareAvx2(loads, one, other, sum);
  addLargerSquareAny(loads, one, other, sum);
}

}  // namespace hammer_loads
