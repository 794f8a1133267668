// Against the same by whole matrices, for blocks of every size and place a filter can have.
#include "hammer_loads/boom/covariance_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

namespace hammer_loads {
namespace {

constexpr int kMatrixStride = 20;
constexpr double kOfKernels = 1e-14;
using FilterMatrix = Eigen::Matrix<double, kMatrixStride, kMatrixStride>;

struct NormalDraw {
  std::mt19937 random{81};
  double operator()() { return std::normal_distribution<>()(random); }
  FilterMatrix covariance() {
    const FilterMatrix root = FilterMatrix::NullaryExpr([this] { return (*this)(); });
    const FilterMatrix P = root * root.transpose();
    return 0.5 * (P + P.transpose());
  }
};

template <typename Each>
void forEachBlock(const Each& each) {
  for (int first = 0; first < kMatrixStride; ++first) {
    for (int last = first + 1; last <= kMatrixStride; ++last) each(first, last);
  }
}

TEST(CovarianceKernels, SubtractSquareChangesItsBlockAlone) {
  NormalDraw draw;
  const FilterMatrix P = draw.covariance();
  forEachBlock([&](int first, int last) {
    const int n = last - first;
    for (const double S : {0.7, -1.9}) {  // negative: given back
      const Eigen::VectorXd column = Eigen::VectorXd::NullaryExpr(n, [&] { return draw(); });
      FilterMatrix changed = P, right = P;
      subtractSquare(changed.block(first, first, n, n), column, S);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) right(first + i, first + j) -= column[i] * column[j] / S;
      EXPECT_LT((changed - right).norm(), kOfKernels * P.norm());
      right.block(first, first, n, n) = changed.block(first, first, n, n);
      EXPECT_EQ(changed, right);
    }
  });
}

TEST(CovarianceKernels, ReplaceTwoIsATransformation) {
  NormalDraw draw;
  const FilterMatrix P = draw.covariance();
  constexpr int kFirst = 8;
  const std::array<int, 6> states{kFirst, kFirst + 1, kFirst + 2, kFirst + 3, 6, 11};
  for (int first : {0, 3, 4}) {
    for (int last : {12, 16, 20}) {
      FilterMatrix F = FilterMatrix::Identity();
      F.row(kFirst).setZero(), F.row(kFirst + 1).setZero();
      TwoOf of;
      for (int k = 0; k < 4 + last % 3; ++k) {  // an odd and an even number of states
        const int state = states[static_cast<std::size_t>(k)];
        const double one = draw(), other = draw();
        of.add(state - first, one, other);
        F(kFirst, state) += one, F(kFirst + 1, state) += other;  // one may come twice
      }
      FilterMatrix changed = P;
      const int n = last - first;
      replaceTwo(changed.block(first, first, n, n), kFirst - first, of);
      const Eigen::MatrixXd inner = F.block(first, first, n, n);
      const Eigen::MatrixXd right = inner * P.block(first, first, n, n) * inner.transpose();
      EXPECT_LT((changed.block(first, first, n, n) - right).norm(), kOfKernels * right.norm());
      EXPECT_EQ(changed, FilterMatrix(changed.transpose())) << "symmetric to the bit, where it was";
    }
  }
}

}  // namespace
}  // namespace hammer_loads
