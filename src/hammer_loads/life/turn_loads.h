/// Least, largest and mean load of each channel over a turn of the crank, and their uncertainty.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::life {

/// Standard deviations, in the load's unit: of this sample alone, and of constants, the same in all samples; NaN: not
/// known.
struct LoadError {
  double own{kNaN}, common{kNaN};

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
  double least{kInfinity}, greatest{-kInfinity};
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

/// Least or largest load of one channel over a turn.
struct LoadExtreme {
  double value{kNaN};
  std::int64_t instant{};  ///< the first time that it was reached [ns]
  LoadError error;         ///< error of the sample, or of the one beside it
};

/// Loads of one channel over a turn; NaN where it had no value.
struct ChannelTurn {
  LoadExtreme minimum, maximum;  ///< extremes of samples and of the instants between them
  double mean{kNaN};             ///< over time
};

struct TurnLoads {
  std::int64_t start{}, end{};        ///< instants of the blows [ns]
  bool whole{};                       ///< true if it began with a blow; else with the first sample
  std::vector<ChannelTurn> channels;  ///< in the order of the values
};

/// Takes every sample and every extreme between samples, in time order. All memory is allocated at the start.
///
/// The mean is the integral by the trapezoidal rule over the time between the first and the last instant with a value;
/// from there to the blows the first and the last value hold, as a blow may change a load at once.
class TurnLoadsRecorder {
 public:
  explicit TurnLoadsRecorder(std::size_t channels);

  /// Takes one value per channel at an instant [ns]; NaN or infinity: none. An instant that is not after the one before
  /// counts for the extremes, but not for the mean.
  /// Deviations as LifeRecorder::sample().
  void add(std::int64_t instant, const double* values, const double* deviations = nullptr,
           const double* common = nullptr) noexcept;
  /// The blow at `instant` ends the turn. Valid until the next call.
  const TurnLoads& endTurn(std::int64_t instant) noexcept;
  /// Samples are missing, or time ran back: forgets the turn begun. The next one begins with its first value.
  void restart() noexcept;

 private:
  struct Integral {
    std::int64_t first{}, last{};  ///< instants [ns]
    double first_value{}, last_value{}, sum{};
    bool begun{};
  };
  void clear() noexcept;

  TurnLoads turn_, result_;
  std::vector<Integral> integrals_;
  bool started_{};  ///< by a sample or a blow
};

}  // namespace hammer_loads::life
