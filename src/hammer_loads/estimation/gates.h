/// Gates as numbers of standard deviations, which separate noise from other effects, and latches.
#pragma once

#include <cmath>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Standard deviations of a normal distribution, and how often a value is beyond them. At a thousand measurements a
/// second, noise exceeds five about twice an hour.
namespace gate {
constexpr double kUsual = 2.0;       ///< 5 in 100
constexpr double kRare = 3.0;        ///< 3 in 1000: three times a second
constexpr double kVeryRare = 4.0;    ///< 6 in 100 000: some four times a minute
constexpr double kImpossible = 5.0;  ///< 6 in 10 million: twice an hour
}  // namespace gate

/// Logarithms of odds.
namespace odds {
constexpr double kLikely = 2.0;  ///< 7 to 1
}  // namespace odds

/// Levels of the mean of innovation^2 over its variance. A correct model has 1, or a little less. Values for wrong
/// models are stated where the levels are used.
namespace mismatch {
constexpr double kSeen = 2.0;         ///< an error of the model is visible
constexpr double kUnexplained = 3.0;  ///< level for a warning
constexpr double kContradicts = 4.0;  ///< the model is wrong
}  // namespace mismatch

/// Returns true if an innovation of that variance is beyond this many standard deviations; false for NaN.
constexpr bool exceeds(double innovation, double variance, double deviations) noexcept {
  return square(innovation) > square(deviations) * variance;
}

/// Weight of an innovation: 1 within this many standard deviations; beyond, its square counts as that of the gate.
inline double weightWithin(double deviations, double innovation, double variance) noexcept {
  const double ratio = square(innovation) / variance, most = square(deviations);
  return ratio > most ? most / ratio : 1.0;
}

/// Latch with hysteresis: a value near one level does not make it flicker. NaN releases it.
class Latch {
 public:
  static constexpr double kReleased = 0.5;  ///< part of the level at which it engages

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
