/// Covariance of a Kalman filter whose number of states varies.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace hammer_loads {

constexpr int kMostStates = 64;

/// The part of a covariance in use: a square block on its diagonal, of at most kMostStates.
using CovarianceBlock = Eigen::Ref<Eigen::MatrixXd>;

/// P <- P - column column^T/S. S below 0 gives back.
void subtractSquare(CovarianceBlock P, const Eigen::Ref<const Eigen::VectorXd>& column, double S) noexcept;

/// New values of two neighbouring states: weighted sums over two states or more, which include both.
struct TwoOf {
  static constexpr int kMost = 24;
  int count{};
  std::array<int, kMost> state;
  std::array<double, kMost> by_one, by_other;

  void add(int of, double one, double other) noexcept {
    const auto i = static_cast<std::size_t>(count++);
    state[i] = of, by_one[i] = one, by_other[i] = other;
  }
};

/// Some of the states.
struct StateList {
  std::array<int, kMostStates> states;  ///< the first of them
  int count{};
  void add(int state) noexcept { states[static_cast<std::size_t>(count++)] = state; }
  const int* begin() const noexcept { return states.data(); }
  const int* end() const noexcept { return states.data() + count; }
};

/// P <- F P F^T, where F makes the states `first` and the one after it. P stays symmetric to the last bit.
void replaceTwo(CovarianceBlock P, int first, const TwoOf& of) noexcept;

}  // namespace hammer_loads
