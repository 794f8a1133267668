/// Error of an estimated signal against the true one.
#pragma once

#include <algorithm>
#include <cmath>

namespace hammer_loads::accuracy {

/// Errors over root mean square and over the largest of the truth.
struct SignalError {
  double square{}, size{}, worst{}, largest{}, sum[2]{}, squares[2]{}, product{};
  double lowest{1e300}, highest{-1e300};
  int count{};
  void add(double estimate, double truth) {
    sum[0] += estimate, sum[1] += truth, squares[0] += estimate * estimate, squares[1] += truth * truth;
    product += estimate * truth;
    square += std::pow(estimate - truth, 2), size += truth * truth, ++count;
    lowest = std::min(lowest, truth), highest = std::max(highest, truth);
    worst = std::max(worst, std::abs(estimate - truth)), largest = std::max(largest, std::abs(truth));
  }
  double range() const { return highest - lowest; }
  double rms() const { return std::sqrt(square / size); }
  double rmsOfRange() const { return std::sqrt(square / count) / range(); }
  double rmsOfLargest() const { return std::sqrt(square / count) / largest; }
  double correlation() const {
    return (product - sum[0] * sum[1] / count) /
           std::sqrt((squares[0] - sum[0] * sum[0] / count) * (squares[1] - sum[1] * sum[1] / count));
  }
  double worstOfLargest() const { return worst / largest; }
};

}  // namespace hammer_loads::accuracy
