/// Mean of what came lately.
#pragma once

#include <algorithm>
#include <limits>

namespace hammer_loads {

/// Mean of all values at first, later with weights that fall by 1 - weight/length from one value to the next. Weights
/// are a count or a time, length is in their unit.
template <typename Value = double>
class RunningMean {
 public:
  /// Mean of all values with equal weights.
  RunningMean() noexcept : RunningMean(std::numeric_limits<double>::infinity()) {}
  /// length > 0; first: counts as this many values, in [0, length].
  explicit RunningMean(double length, const Value& first = Value(), double first_counts = 0.0) noexcept
      : length_(length), count_(first_counts), mean_(first) {}

  /// weight: > 0; nothing weighs more than all.
  void add(const Value& value, double weight = 1.0) noexcept {
    count_ = std::min(count_ + weight, length_);
    mean_ += std::min(1.0, weight / count_) * (value - mean_);
  }
  const Value& mean() const noexcept { return mean_; }
  double count() const noexcept { return count_; }  ///< sum of the weights in the mean, <= length
  /// Returns true if the mean has its full length.
  bool isFull() const noexcept { return count_ == length_; }

 private:
  double length_, count_;
  Value mean_;
};

}  // namespace hammer_loads
