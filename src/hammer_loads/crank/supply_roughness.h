/// How rough the supply is, learned from innovations that ought to be independent of each other.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {

/// The torque's random walk is given for rough supplies. Exact samples hardly ask for it. Stamps that jitter are
/// averaged over many samples, and their noise passes for torque where the walk is too large: successive innovations
/// then change their sign too often. Where it is too small they keep it. So each product of an innovation and the
/// fading sum of those before it moves the walk a little. The given one holds while stamps are exact.
class SupplyRoughness {
 public:
  /// innovation of variance `total`, of which the stamp's jitter has the part `jitter`.
  void learn(double innovation, double total, double jitter) noexcept {
    const double now = std::clamp(innovation / std::sqrt(total), -gate::kRare, gate::kRare);
    factor_ = jitter > 0.0 ? std::clamp(factor_ * (1.0 + kGain * jitter * now * sum_), kLeast, kMost) : 1.0;
    sum_ = now + kFading * sum_;
  }
  /// Of the given walk [-].
  double factor() const noexcept { return factor_; }
  /// What the part of the torque's deviation that is real is multiplied with: a smaller walk has a smaller deviation,
  /// while the supply stays what it is. Measured: the coverage is that of exact stamps then.
  double deviationFactor() const noexcept { return 1.0 / std::sqrt(std::sqrt(std::min(1.0, factor_))); }

 private:
  static constexpr double kGain = 1.0 / look_back::kReadings;
  static constexpr double kFading = 0.85;              // some 7 samples are looked at
  static constexpr double kLeast = 0.25, kMost = 3.0;  // a sudden supply is still followed within some samples
  // Guard: LearnedNumbers.TheSupplysWalk of kFading
  // Prior: LearnedNumbers.TheSupplysWalk of kLeast, kMost
  double factor_{1.0}, sum_{};
};

}  // namespace hammer_loads
