/// Ratio of the innovations to their predicted size, overall and by the place in the revolution.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

constexpr double kMostNormalised = 100.0;  ///< limit for one sample, so that a single outlier raises no alarm

/// Running mean of innovation^2 over its variance, over some 500 samples: 1 for a correct model.
class Consistency {
 public:
  void add(double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    if (samples_ < kLength) ++samples_;
    mean_ += (std::min(squared_over_variance, kMostNormalised) - mean_) / samples_;
  }
  /// NaN before 200 samples.
  double mean() const noexcept { return samples_ < kEnough ? std::numeric_limits<double>::quiet_NaN() : mean_; }
  /// Factor on the variances from which the filter learns, at least 1.
  double growth() const noexcept { return samples_ < kEnough ? 1.0 : publishedGrowth(); }
  /// Factor on published variances. Samples that the mean still lacks count with the factor before the restart.
  double publishedGrowth() const noexcept {
    const double known = std::min(1.0, static_cast<double>(samples_) / kEnough);
    return std::max(1.0, known * mean_ + (1.0 - known) * before_);
  }
  /// Restarts the mean for another estimate, whose initial uncertainty is the same.
  void restart() noexcept {
    before_ = publishedGrowth();
    samples_ = 0, mean_ = 0.0;
  }

 private:
  static constexpr int kLength = 500, kEnough = 200;
  int samples_{};
  double mean_{};
  double before_{1.0};  ///< publishedGrowth() before the restart
};

/// Mean of innovation^2 over its variance by half revolutions before the blow. The lesser of the last two counts: a
/// single disturbance raises no alarm, and one half revolution that agrees ends it.
class StrikeConsistency {
 public:
  void add(double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    sum_ += std::min(squared_over_variance, kMostNormalised);
    ++samples_;
  }
  /// Ends the half revolution at a passage of the blow.
  void endHalfTurn() noexcept {
    if (samples_ == 0) return;
    before_ = std::exchange(last_, sum_ / samples_);
    abandon();
  }
  /// Discards a half revolution that was not seen whole.
  void abandon() noexcept { sum_ = 0.0, samples_ = 0; }
  /// Returns NaN before two half revolutions.
  double mean() const noexcept { return before_ < last_ ? before_ : (before_ >= last_ ? last_ : before_); }

 private:
  double sum_{};
  int samples_{};
  double before_{std::numeric_limits<double>::quiet_NaN()}, last_{before_};
};

/// Evidence of an elastic rod. Such a rod accelerates the rocker just after the blow, where the linkage has no lever on
/// it. Its vibration has decayed a quarter of a revolution later. A wrong sensor, wrong masses or a soft coupling
/// contradict the model elsewhere as well. With 4096 counts at 1 kHz the means of innovation^2 over its variance at
/// both places are
///
///     rods of 2e8 to 1e10 N/m     4.3 to 50 and 0.9 to 3      zero off by 2 deg, eccentric by 1.2   1.0 to 1.5 and 1.0
///     coupling of 50 Hz            9 to 12 and 3 to 7         clean, other masses, late tool        0.9 to 1.0 and 1.0
class RodEvidence {
 public:
  /// Adds an innovation at a place of the crank.
  void add(const CrankAngle& at, double squared_over_variance) noexcept {
    if (!std::isfinite(squared_over_variance)) return;
    const double bounded = std::min(squared_over_variance, kMostNormalised);
    if (at.side == Side::kBeforeBlow) {
      if (at.offset > -kPickedUp) run_up_.add(bounded);
      return;
    }
    if (at.offset < kPickedUp) picked_up_.add(bounded);
    if (at.offset > kRungOut) later_.add(bounded);
  }
  /// Angles from the blow at which an elastic rod has accelerated the rocker and at which its vibration has decayed
  /// [rad].
  static constexpr double kPickedUp = 30.0 * kDegree, kRungOut = 90.0 * kDegree;
  /// Standard deviation of a reading above which a rod cannot be detected [rad], since errors of the sensor's mounting
  /// would be taken for the rod's stiffness.
  static constexpr double kCoarsest = 1e-3;
  /// Means while the rod accelerates the rocker, and after its vibration has decayed [-].
  double pickedUp() const noexcept { return picked_up_.mean(); }
  double later() const noexcept { return later_.mean(); }
  /// Upper bounds, from the readings, of the square of the vibration and of the missing speed of a released rocker, as
  /// parts of the expected values. reading: standard deviation of a reading [rad].
  double share(double reading) const noexcept { return shareOf(picked_up_, reading); }
  double releasedShare(double reading) const noexcept { return shareOf(run_up_, reading); }
  /// Returns true if a rigid mechanism loses the crank even a quarter of a revolution after the blow (8 to 20 then).
  /// Rock that throws the rocker back has this effect; the identified blow is then wrong.
  bool isLost() const noexcept { return later_.count() > kEnough && later() > mismatch::kUnexplained; }
  bool showsElasticRod() const noexcept {
    return picked_up_.count() > kEnough && pickedUp() > mismatch::kSeen && pickedUp() - 1.0 > kShare * (later() - 1.0);
  }

 private:
  static double shareOf(const RunningMean<>& place, double reading) noexcept {
    if (!(reading < kCoarsest) || !(place.count() > kEnough)) return 1.0;
    const double margin = gate::kUsual * std::sqrt(2.0 / place.count());
    return std::clamp((place.mean() - 1.0 + margin) / mismatch::kUnexplained, 0.0, 1.0);
  }
  static constexpr double kEnough = 40.0;  ///< ten revolutions at 200 Hz; standard deviation of the mean 0.22
  static constexpr double kShare = 5.0;
  static constexpr double kSamples = 400.0;  ///< samples of the first two means: some 20 revolutions at 1 kHz
  RunningMean<> run_up_{kSamples}, picked_up_{kSamples}, later_{kSamples * (kPi - kRungOut) / kPickedUp};
};

}  // namespace hammer_loads
