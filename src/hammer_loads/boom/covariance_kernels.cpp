#include "hammer_loads/boom/covariance_kernels.h"

namespace hammer_loads {

void subtractSquare(CovarianceBlock P, const Eigen::Ref<const Eigen::VectorXd>& column, double S) noexcept {
  const double by = 1.0 / S;
  for (Eigen::Index j = 0; j < P.cols(); ++j) P.col(j) -= by * column[j] * column;
}

void replaceTwo(CovarianceBlock P, int first, const TwoOf& of) noexcept {
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;
  // Products of P and a row of F.
  Column one = of.by_one[0] * P.col(of.state[0]) + of.by_one[1] * P.col(of.state[1]);
  Column other = of.by_other[0] * P.col(of.state[0]) + of.by_other[1] * P.col(of.state[1]);
  std::size_t k = 2;
  for (const auto count = static_cast<std::size_t>(of.count); k + 1 < count; k += 2) {
    const auto a = P.col(of.state[k]), b = P.col(of.state[k + 1]);
    one += of.by_one[k] * a + of.by_one[k + 1] * b;
    other += of.by_other[k] * a + of.by_other[k + 1] * b;
  }
  if (k < static_cast<std::size_t>(of.count)) {
    one += of.by_one[k] * P.col(of.state[k]), other += of.by_other[k] * P.col(of.state[k]);
  }
  const auto times = [&](const Column& column, const std::array<double, TwoOf::kMost>& by) {
    double sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(of.count); ++i) sum += by[i] * column[of.state[i]];
    return sum;
  };
  const double both = 0.5 * (times(one, of.by_other) + times(other, of.by_one));
  one[first] = times(one, of.by_one), other[first + 1] = times(other, of.by_other);
  one[first + 1] = other[first] = both;
  P.col(first) = one, P.col(first + 1) = other;
  P.row(first) = one.transpose(), P.row(first + 1) = other.transpose();
}

}  // namespace hammer_loads
