#include "hammer_loads/boom/covariance_kernels.h"

namespace hammer_loads {

void subtractSquare(CovarianceBlock P, const Eigen::Ref<const Eigen::VectorXd>& column, double S) noexcept {
  const double by = 1.0 / S;
  for (Eigen::Index j = 0; j < P.cols(); ++j) P.col(j) -= by * column[j] * column;
}

void replaceTwo(CovarianceBlock P, int first, const std::array<int, 5>& of, const std::array<double, 5>& by_one,
                const std::array<double, 5>& by_other) noexcept {
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;
  const auto product = [&](const std::array<double, 5>& by) -> Column {  // of P and a row of F
    return by[0] * P.col(of[0]) + by[1] * P.col(of[1]) + by[2] * P.col(of[2]) + by[3] * P.col(of[3]) +
           by[4] * P.col(of[4]);
  };
  const auto times = [&](const Column& column, const std::array<double, 5>& by) {
    double sum = 0.0;
    for (std::size_t k = 0; k < by.size(); ++k) sum += by[k] * column[of[k]];
    return sum;
  };
  Column one = product(by_one), other = product(by_other);
  const double both = 0.5 * (times(one, by_other) + times(other, by_one));
  one[first] = times(one, by_one), other[first + 1] = times(other, by_other);
  one[first + 1] = other[first] = both;
  P.col(first) = one, P.col(first + 1) = other;
  P.row(first) = one.transpose(), P.row(first + 1) = other.transpose();
}

}  // namespace hammer_loads
