/// A state that engages at one level and is released at another.
#pragma once

namespace hammer_loads {

/// A value that hovers about one level does not make it flicker. Where the level is no number it is released.
class Latch {
 public:
  static constexpr double kReleased = 0.5;  ///< of the level at which it engages
  // Guard: SpeedTrust.WhatShowedOnceIsReleasedAtHalf of kReleased

  explicit Latch(double engages) noexcept : Latch(engages, kReleased * engages) {}
  /// releases <= engages.
  constexpr Latch(double engages, double releases) noexcept : engages_(engages), releases_(releases) {}

  bool follow(double level) noexcept { return engaged_ = level > (engaged_ ? releases_ : engages_); }
  bool isEngaged() const noexcept { return engaged_; }

 private:
  double engages_, releases_;
  bool engaged_{};
};

}  // namespace hammer_loads
