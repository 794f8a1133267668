/// What an encoder's reading says about the angle.
#pragma once

#include <cmath>

namespace hammer_loads {

/// An encoder counts down to the last whole count, so a reading means the middle of its count. A reading that is no
/// multiple of the count comes from a finer sensor: after a few of them all readings are taken as they are.
class Encoder {
 public:
  /// Count [rad], > 0.
  explicit Encoder(double resolution) noexcept : resolution_(resolution) {}

  double angle(double reading) noexcept {
    const double counts = reading / resolution_;
    if (std::abs(counts - std::nearbyint(counts)) > kMultipleTolerance && finer_readings_ < kEnough) ++finer_readings_;
    return finer_readings_ < kEnough ? reading + 0.5 * resolution_ : reading;
  }

  /// Variance of angle() [rad2]: uniform over the count; kept for a finer sensor, whose noise nobody stated.
  double variance() const noexcept { return resolution_ * resolution_ / 12.0; }
  bool isFiner() const noexcept { return finer_readings_ >= kEnough; }

 private:
  static constexpr double kMultipleTolerance = 1e-3;  // of a count; single-precision sensors round by 4e-4 of 2 pi/4096
  static constexpr int kEnough = 2;
  double resolution_;
  int finer_readings_{};
};

}  // namespace hammer_loads
