/// Whether the innovations are as large as the filter says.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace hammer_loads {

/// Running mean of innovation^2 over its variance: 1 for a model that holds. Some 500 samples long.
class Consistency {
 public:
  void add(double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    if (samples_ < kLength) ++samples_;
    mean_ += (std::min(squared_over_variance, kMost) - mean_) / samples_;
  }
  /// NaN before 200 samples.
  double mean() const noexcept { return samples_ < kEnough ? std::numeric_limits<double>::quiet_NaN() : mean_; }
  /// What variances are to be multiplied with: never below 1.
  double growth() const noexcept { return samples_ < kEnough ? 1.0 : std::max(1.0, mean_); }

 private:
  static constexpr int kLength = 500, kEnough = 200;
  static constexpr double kMost = 100.0;  // of one sample: a single outlier is no alarm
  int samples_{};
  double mean_{};
};

}  // namespace hammer_loads
