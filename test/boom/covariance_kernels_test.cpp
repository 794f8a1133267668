// Kernels against the same in Eigen's plain products, for blocks of every size and place a filter can have.
#include "hammer_loads/boom/covariance_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

#include "hammer_loads/boom/load_errors.h"

namespace hammer_loads {
namespace {

constexpr int kMatrixStride = 20;
constexpr double kOfKernels = 1e-14;
using FilterMatrix = Eigen::Matrix<double, kMatrixStride, kMatrixStride>;
using FilterVectors = Eigen::Matrix<double, kMatrixStride, kMostAtOnce>;

struct NormalDraw {
  std::mt19937 random{81};
  double operator()() { return std::normal_distribution<>()(random); }
  FilterMatrix covariance() {
    const FilterMatrix root = FilterMatrix::NullaryExpr([this] { return (*this)(); });
    const FilterMatrix P = root * root.transpose();
    return 0.5 * (P + P.transpose());
  }
};

/// Blocks of fours.
template <typename Each>
void forEachBlock(const Each& each) {
  for (int first = 0; first < kMatrixStride; first += 4) {
    for (int last = first + 4; last <= kMatrixStride; last += 4) each(first, last);
  }
}

TEST(CovarianceKernels, TimesRowsIsAProductWithinItsBlock) {
  NormalDraw draw;
  FilterMatrix P = draw.covariance();
  forEachBlock([&](int first, int last) {
    if (last - first < 8) return;  // a row has a place of its own before the others
    const int begin = first + 4, n = last - first;
    FilterVectors rows = FilterVectors::Zero();
    int unit[kMostAtOnce];
    for (int k = 0; k < kMostAtOnce; ++k) {
      for (int i = begin; i < last; ++i) rows(i, k) = draw();
      unit[k] = first + k;
      rows(unit[k], k) = 1.0;
    }
    for (int count = 1; count <= kMostAtOnce; ++count) {
      FilterVectors results = FilterVectors::Constant(7.0);
      timesRows({P.data(), kMatrixStride, first, last}, count, rows.data(), begin, unit, results.data());
      for (int k = 0; k < kMostAtOnce; ++k) {
        if (k >= count) {
          EXPECT_TRUE((results.col(k).array() == 7.0).all());
          continue;
        }
        const Eigen::VectorXd right = P.block(first, first, n, n) * rows.col(k).segment(first, n);
        EXPECT_LT((results.col(k).segment(first, n) - right).norm(), kOfKernels * P.norm() * rows.col(k).norm());
        EXPECT_TRUE((results.col(k).head(first).array() == 7.0).all());
        EXPECT_TRUE((results.col(k).tail(kMatrixStride - last).array() == 7.0).all());
      }
    }
  });
}

TEST(CovarianceKernels, SubtractSquaresChangesItsBlockAlone) {
  NormalDraw draw;
  const FilterMatrix P = draw.covariance();
  forEachBlock([&](int first, int last) {
    const int n = last - first;
    const FilterVectors columns = FilterVectors::NullaryExpr([&] { return draw(); });
    const double S[] = {0.7, -1.9, 3.1};  // negative: given back
    for (int count = 1; count <= kMostAtOnce; ++count) {
      FilterMatrix changed = P, right = P;
      subtractSquares({changed.data(), kMatrixStride, first, last}, count, columns.data(), S);
      for (int k = 0; k < count; ++k) {
        const Eigen::VectorXd column = columns.col(k).segment(first, n);
        right.block(first, first, n, n) -= column * column.transpose() / S[k];
      }
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
  const std::array<int, 5> of{kFirst, kFirst + 1, kFirst + 2, kFirst + 3, 6};
  for (int first : {0, 4}) {
    for (int last : {12, 16, 20}) {
      std::array<double, 5> one, other;
      for (double& by : one) by = draw();
      for (double& by : other) by = draw();
      FilterMatrix F = FilterMatrix::Identity();
      F.row(kFirst).setZero(), F.row(kFirst + 1).setZero();
      for (std::size_t k = 0; k < 5; ++k) F(kFirst, of[k]) = one[k], F(kFirst + 1, of[k]) = other[k];
      FilterMatrix changed = P;
      replaceTwo({changed.data(), kMatrixStride, first, last}, kFirst, of, one, other);
      const int n = last - first;
      const Eigen::MatrixXd inner = F.block(first, first, n, n);
      const Eigen::MatrixXd right = inner * P.block(first, first, n, n) * inner.transpose();
      EXPECT_LT((changed.block(first, first, n, n) - right).norm(), kOfKernels * right.norm());
      EXPECT_EQ(changed, FilterMatrix(changed.transpose())) << "symmetric to the bit, where it was";
    }
  }
}

TEST(CovarianceKernels, VariancesAreThoseOfTheCovariance) {
  NormalDraw draw;
  for (int inputs = 1; inputs <= LoadErrors::kMost; ++inputs) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(inputs, inputs, [&] { return draw(); });
    const Eigen::MatrixXd covariance = root * root.transpose();
    Eigen::MatrixXd lower = Eigen::MatrixXd::Constant(20, inputs, 1e9);  // what is not to be read
    Eigen::VectorXd one(inputs), other(inputs);
    for (int k = 0; k < inputs; ++k) {
      one[k] = draw(), other[k] = draw();
      for (int i = k; i < inputs; ++i) lower(i, k) = covariance(i, k);
    }
    for (int loads : {1, 4, 7}) {
      const int fours = (loads + 3) / 4;
      const Eigen::MatrixXd by = Eigen::MatrixXd::NullaryExpr(loads, inputs, [&] { return draw(); });
      Eigen::Matrix<double, 4, Eigen::Dynamic> stored = Eigen::MatrixXd::Zero(4, fours * inputs);
      for (int row = 0; row < loads; ++row)
        for (int i = 0; i < inputs; ++i) stored(row % 4, row / 4 * inputs + i) = by(row, i);
      Eigen::VectorXd variance = Eigen::VectorXd::Constant(4 * fours, -1.0);
      findVariances({stored.data(), loads, inputs}, lower.data(), 20, variance.data());
      const Eigen::VectorXd right = (by * covariance * by.transpose()).diagonal();
      EXPECT_LT((variance.head(loads) - right).norm(), 1e-13 * right.norm());
      EXPECT_TRUE((variance.tail(4 * fours - loads).array() == 0.0).all());
      Eigen::VectorXd rounded = variance;
      const Eigen::MatrixXd negative = -lower;
      findVariances({stored.data(), loads, inputs}, negative.data(), 20, rounded.data());
      EXPECT_TRUE((rounded.array() == 0.0).all()) << "never below zero, whatever rounding makes of it";
      addLargerSquare({stored.data(), loads, inputs}, one.data(), other.data(), variance.data());
      const Eigen::VectorXd larger = (by * one).cwiseAbs2().cwiseMax((by * other).cwiseAbs2());
      EXPECT_LT((variance.head(loads) - right - larger).norm(), 1e-13 * (right + larger).norm());
    }
  }
}

}  // namespace
}  // namespace hammer_loads
