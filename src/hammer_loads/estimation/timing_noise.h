/// Jitter of the samples' stamps, learned from residuals of the angles.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// A stamp off by d shows an angle off by w d: the innovation's variance has a part w^2 sigma_t^2. Its maximum of
/// likelihood is followed sample by sample (score over information, both by the normal distribution), within some 200
/// samples that turn. Jitter has no memory, what a model lacks has: innovations are seen by the half square of their
/// differences. Jitter that the encoder's count alone could explain counts as zero: exact stamps stay exact.
class TimingNoise {
 public:
  /// first_guess: standard deviation [s], >= 0.
  explicit TimingNoise(double first_guess = 0.0) noexcept : variance_(first_guess * first_guess) {}
  /// Learns anew from this deviation [s], which counts until the samples show another one.
  void restart(double deviation) noexcept {
    *this = TimingNoise(deviation);
    information_ = 1.0 / square(variance_);
  }

  /// innovation [rad] of variance `total`, the jitter's part included; speed w [rad/s]; step [s] since
  /// the sample before.
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
    // Samples show the less of a stamp the more it jitters.
    information_ /= square(1.0 + std::sqrt(information_) * (variance_ - before));
  }

  /// Variance of a stamp [s2]; exactly zero where no jitter is seen.
  double variance() const noexcept {
    return square(variance_) * information_ > square(gate::kRare) * kGain ? variance_ : 0.0;
  }
  double deviation() const noexcept { return std::sqrt(variance()); }  ///< [s]

 private:
  static constexpr double kGain = 1.0 / look_back::kReadings;
  static constexpr int kLearning =
      60;  // samples: a wrong first guess of the inertia passes for jitter, and counts less
  static constexpr double kFirstCounts = 50.0;  // samples that the first guess stands for
  static constexpr double kFirstOfSparse =
      10.0;  // samples of the first guess at sparse samples, as the filter at 100 Hz would restart until then
  static constexpr double kSparse = 0.008;  // [s]
  static constexpr double kVisible = 9e-8;  // [s2]: a sample that could not see 0.3 ms is not asked
  double variance_;
  double last_{};  ///< innovation [rad]
  double information_{};
  int samples_{};
};

}  // namespace hammer_loads
