/// Angles that are filtered: how far a reading is behind its crank.
#pragma once

#include <algorithm>
#include <cmath>

namespace hammer_loads {

/// A low-pass of first order, lag y' = angle - y: by the exact answer to an even acceleration within a step, angle - y
/// is lag (w - lag w') and what is left of the step's start. A reading that is late by as much looks alike but for
/// lag^2 w'/2. Measured speeds show it (SpeedTrust): they cannot be ahead of their crank.
class AngleLag {
 public:
  bool isThere() const noexcept { return lag_ > 0.0; }
  double lag() const noexcept { return lag_; }              ///< taken off the readings [s]
  double deviation() const noexcept { return deviation_; }  ///< of that, standard [s]
  /// more: seen in readings from which lag() has been taken off [s]; deviation: of it.
  void take(double more, double deviation) noexcept {
    lag_ = std::max(0.0, lag_ + more);
    deviation_ = deviation;
  }
  /// The readings begin anew, at an even speed [rad/s].
  void begin(double speed) noexcept { behind_ = lag_ * speed; }
  /// After a step of dt [s] > 0 from one speed to another [rad/s], how far the reading is behind [rad].
  double behind(double from, double to, double dt) const noexcept {
    if (!isThere()) return 0.0;
    const double bent = lag_ * (to - from) / dt;
    return lag_ * (to - bent) + std::exp(-dt / lag_) * (behind_ - lag_ * (from - bent));
  }
  /// The reading at the end of the last step was taken up.
  void go(double behind) noexcept { behind_ = behind; }

 private:
  double lag_{}, deviation_{}, behind_{};
};

}  // namespace hammer_loads
