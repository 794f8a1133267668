/// Whether the innovations are as large as the filter says.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hammer_loads {

constexpr double kMostSurprise = 100.0;  ///< that one sample counts for: a single outlier is no alarm

/// Running mean of innovation^2 over its variance: 1 for a model that holds. Some 500 samples long.
class Consistency {
 public:
  void add(double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    if (samples_ < kLength) ++samples_;
    mean_ += (std::min(squared_over_variance, kMostSurprise) - mean_) / samples_;
  }
  /// NaN before 200 samples.
  double mean() const noexcept { return samples_ < kEnough ? std::numeric_limits<double>::quiet_NaN() : mean_; }
  /// The factor of variances in what the filter learns: never below 1.
  double growth() const noexcept { return samples_ < kEnough ? 1.0 : doubt(); }
  /// The same of what is published: samples that are not there yet count as what was before them.
  double doubt() const noexcept {
    const double known = std::min(1.0, static_cast<double>(samples_) / kEnough);
    return std::max(1.0, known * mean_ + (1.0 - known) * before_);
  }
  /// What comes is of another belief, which is as doubtful at first.
  void restart() noexcept {
    before_ = doubt();
    samples_ = 0, mean_ = 0.0;
  }

 private:
  static constexpr int kLength = 500, kEnough = 200;
  // Guard: LearnedNumbers.ConsistencyIsAMeanOfFiveHundred of kMostSurprise, kLength
  // Guard: LearnedNumbers.AYoungConsistencyIsAsDoubtfulAsTheOneBefore of kEnough
  int samples_{};
  double mean_{};
  double before_{1.0};  ///< doubt() before the restart
};

/// The same of the half turns before the blow: the lesser of the last two, so that one disturbance is no contradiction,
/// and one half turn that agrees ends it.
class StrikeConsistency {
 public:
  void add(double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    sum_ += std::min(squared_over_variance, kMostSurprise);
    ++samples_;
  }
  /// The blow was passed.
  void endHalfTurn() noexcept {
    if (samples_ == 0) return;
    before_ = std::exchange(last_, sum_ / samples_);
    abandon();
  }
  /// Of a half turn that was not seen whole.
  void abandon() noexcept { sum_ = 0.0, samples_ = 0; }
  /// NaN before two half turns.
  double mean() const noexcept { return before_ < last_ ? before_ : (before_ >= last_ ? last_ : before_); }

 private:
  double sum_{};
  int samples_{};
  double before_{std::numeric_limits<double>::quiet_NaN()}, last_{before_};
};

}  // namespace hammer_loads
