/// What this machine's blows have done to the crank so far, as the prior of the next one.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_belief.h"

namespace hammer_loads {

/// Mean and spread of the blows' factors, the last ten or so counting most. A machine whose blows are all alike needs
/// no samples to know the next one; one whose blows differ keeps the doubt that it needs.
class BlowHistory {
 public:
  explicit BlowHistory(const BlowPrior& first) noexcept
      : first_(first), mean_(first.mean), variance_(first.deviation * first.deviation) {}

  /// factor of a blow, its variance and its derivative by the sensor's errors, by all samples since.
  void add(double factor, double variance, const ConstantErrors::Row& by_error) noexcept {
    if (!(variance < 0.25 * variance_ || variance < kLeast * kLeast)) return;  // nothing was learned of it
    if (blows_ < kLength) ++blows_;
    const double gain = 1.0 / (blows_ + kFirstCounts), off = factor - mean_;
    mean_ += gain * off;
    by_error_ += gain * (by_error - by_error_);
    variance_ += gain * (off * off - variance_);
  }

  BlowPrior prior() const noexcept {
    return {mean_, std::clamp(std::sqrt(variance_), std::min(kLeast, first_.deviation), kMost), by_error_};
  }

 private:
  static constexpr int kLength = 10;
  static constexpr double kFirstCounts =
      0.1;                                // blows: the first guess; a wrong conclusion from the first few shows at once
  static constexpr double kLeast = 0.01;  // deviation
  static constexpr double kMost = 0.3;
  BlowPrior first_;
  double mean_, variance_;
  ConstantErrors::Row by_error_{ConstantErrors::Row::Zero()};
  int blows_{};
};

}  // namespace hammer_loads
