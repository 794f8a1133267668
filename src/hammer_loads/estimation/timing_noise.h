/// Jitter of the samples' stamps, identified from residuals of the angles.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// An error d of a stamp appears as an angle error w d: the innovation's variance contains w^2 sigma_t^2. The maximum
/// likelihood estimate of it is tracked sample by sample (score over information, normal distribution), over some 200
/// samples in motion. Jitter is uncorrelated, model errors are not: half the squares of the innovations' differences
/// are used. Jitter that the count alone could explain counts as zero, so that exact stamps remain exact.
class TimingNoise {
 public:
  /// first_guess: standard deviation [s], >= 0.
  explicit TimingNoise(double first_guess = 0.0) noexcept : variance_(first_guess * first_guess) {}
  /// Restarts from this standard deviation [s], which is used until the samples show another one.
  void restart(double deviation) noexcept {
    *this = TimingNoise(deviation);
    information_ = 1.0 / square(variance_);
  }

  /// Adds an innovation [rad] of variance `total`, including jitter, at speed w [rad/s]. step: time since the sample
  /// before [s].
  void learn(double innovation, double total, double speed, double step = 0.0) noexcept {
    const double change = innovation - last_;
    last_ = innovation;
    const double squared_speed = speed * speed, lever = squared_speed / total;
    const double visible = std::max(kVisible, variance_);
    if (!(squared_speed * visible > total - squared_speed * variance())) return;  // too slow to show it
    if (samples_++ == 0) information_ = lever * lever;
    const double gain = std::max(kGain, 1.0 / (samples_ + (step > kSparse ? kFirstOfSparse : kFirstCounts)));
    information_ += gain * (lever * lever - information_);
    const double clipped =
        std::min(0.5 * change * change / total, square(samples_ < kLearning ? gate::kUsual : gate::kRare));
    const double before = variance_;
    variance_ = std::max(0.0, variance_ + gain * (clipped - 1.0) * lever / information_);
    // More jitter reduces the information of a sample on it.
    information_ /= square(1.0 + std::sqrt(information_) * (variance_ - before));
  }

  /// Variance of a stamp [s2]; exactly zero if no jitter is detected.
  double variance() const noexcept {
    return square(variance_) * information_ > square(gate::kRare) * kGain ? variance_ : 0.0;
  }
  double deviation() const noexcept { return std::sqrt(variance()); }  ///< [s]

 private:
  static constexpr double kGain = 1.0 / look_back::kReadings;
  static constexpr int kLearning = 60;          // samples that count less: a wrong inertia looks like jitter
  static constexpr double kFirstCounts = 50.0;  // weight of the first guess in samples
  static constexpr double kFirstOfSparse =
      10.0;  // as above for sparse samples, since the filter at 100 Hz would restart until then
  static constexpr double kSparse = 0.008;  // [s]
  static constexpr double kVisible = 9e-8;  // [s2]: samples that cannot show 0.3 ms are not used
  double variance_;
  double last_{};  ///< innovation [rad]
  double information_{};
  int samples_{};
};

}  // namespace hammer_loads
