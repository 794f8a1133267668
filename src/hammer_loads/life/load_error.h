/// Uncertainty of a load, and of the range between a revolution's extremes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace hammer_loads::life {

/// Standard deviations, in the load's unit: of this sample alone, and of constants, the same in all samples; NaN: not
/// known.
struct LoadError {
  double own{std::numeric_limits<double>::quiet_NaN()}, common{std::numeric_limits<double>::quiet_NaN()};

  static LoadError of(double deviation, double common) noexcept {
    return {std::sqrt(std::max(0.0, deviation * deviation - common * common)), common};
  }
  /// Error of the i-th load; deviations null: not known, common null: none.
  static LoadError at(std::size_t i, const double* deviations, const double* common) noexcept {
    return deviations == nullptr ? LoadError{} : of(deviations[i], common == nullptr ? 0.0 : common[i]);
  }
  double deviation() const noexcept { return std::hypot(own, common); }
};

/// Least and largest value of a turn with their errors, and the bounds by the deviations of all samples: where a load
/// is uncertain, its true extreme may exceed those of the values.
struct TurnExtremes {
  double least{std::numeric_limits<double>::infinity()}, greatest{-std::numeric_limits<double>::infinity()};
  double lowest{least}, highest{greatest};  ///< by one own deviation of any sample
  LoadError of_least, of_greatest;

  void add(double value, const LoadError& error) noexcept {
    if (value < least) least = value, of_least = error;
    if (value > greatest) greatest = value, of_greatest = error;
    lowest = std::min(lowest, value - error.own);
    highest = std::max(highest, value + error.own);
  }
  double range() const noexcept { return greatest - least; }
  /// Errors of samples are independent. Errors of constants at the two ends may have any signs; at most their sizes
  /// add.
  LoadError ofRange() const noexcept {
    return {std::hypot(std::max(of_least.own, least - lowest), std::max(of_greatest.own, highest - greatest)),
            of_least.common + of_greatest.common};
  }
};

}  // namespace hammer_loads::life
