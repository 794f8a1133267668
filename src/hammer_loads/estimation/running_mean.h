/// Mean with fading weights of older values.
#pragma once

#include <algorithm>
#include <limits>
#include <type_traits>

namespace hammer_loads {

/// Mean of all values at first; later the weights decrease by 1 - weight/length from one value to the next. Weights are
/// a count or a time, and length is in their unit.
template <typename Value = double>
class RunningMean {
 public:
  /// Mean of all values with equal weights.
  RunningMean() noexcept : RunningMean(std::numeric_limits<double>::infinity()) {}
  /// length > 0; first: initial mean, which counts as `first_counts` values, in [0, length].
  explicit RunningMean(double length, const Value& first = Value(), double first_counts = 0.0) noexcept
      : length_(length), count_(first_counts), mean_(first) {}

  /// Adds a value; weight > 0. A weight of at least length replaces the mean.
  void add(const Value& value, double weight = 1.0) noexcept {
    count_ = std::min(count_ + weight, length_);
    const double part = std::min(1.0, weight / count_);
    if constexpr (std::is_same_v<Value, double>) {
      mean_ += part * (value - mean_);
    } else {
      mean_ += static_cast<typename Value::Scalar>(part) * (value - mean_);
    }
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
