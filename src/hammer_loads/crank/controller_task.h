/// Recognition of a controller that reads the encoder in a task of its own and sends the reading later.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Readings that a controller takes in a task of period T and sends at another rate are as old as its last task. The
/// instants at which they were taken are the stamps corrected by the innovations over the speed. They lie on a grid of
/// T, on which the stamps do not lie; jitter has no grid. The statistic is that of Rayleigh's test, the length of the
/// mean of exp(2 pi i instant/T) over some 200 samples: 1 on the grid, some 0.06 elsewhere. Stamps at equal intervals
/// lie on each grid that divides the interval. A task of such a period is therefore not recognised: the age of its
/// readings is constant.
class ControllerTask {
 public:
  /// Adds a reading with its stamp [ns]. off: innovation of its angle over the speed [s]; 0 where the stamps do not
  /// jitter.
  void add(std::int64_t stamp, double off) noexcept {
    repeats_.add(0.0);
    if (takeStep(stamp) && off != 0.0) findGrid(stamp, off);
  }
  /// Adds a repetition of the last reading with this stamp [ns], although the crank has turned.
  void repeat(std::int64_t stamp) noexcept {
    repeats_.add(1.0);
    takeStep(stamp);
  }

  /// Period of the task that is recognised [s]; 0: none.
  double period() const noexcept {
    const bool often = repeats_.isFull() && repeats_.mean() > kOften && repeats_.mean() < kStuck;
    return often ? step_.mean() / (1.0 - repeats_.mean()) : grid_;
  }

 private:
  /// Adds an interval to their mean, in which jitter cancels. Returns false after a gap.
  bool takeStep(std::int64_t stamp) noexcept {
    const double step = 1e-9 * static_cast<double>(stamp - std::exchange(last_, stamp));
    if (!(std::abs(step) < kLongest)) return false;
    const double mean = step_.mean(), most = kMost * mean;
    step_.add(step_.count() > kFew ? mean + std::clamp(step - mean, -most, most) : step);
    return true;
  }
  void findGrid(std::int64_t stamp, double off) noexcept {
    double length = kRecognised;
    grid_ = 0.0;
    readings_ = std::min(readings_ + 1.0, look_back::kReadings);
    for (std::size_t i = 0; i < kPeriods.size(); ++i) {
      const double period = 1e-3 * static_cast<double>(kPeriods[i]);
      const double turns = (1e-9 * static_cast<double>(stamp % (kPeriods[i] * kMillisecond)) + off) / period;
      taken_[i] += (std::polar(1.0, kTwoPi * turns) - taken_[i]) / readings_;
      const bool divides = std::abs(std::remainder(step_.mean() / period, 1.0)) < kDivides;
      if (divides || !(std::abs(taken_[i]) > length) || readings_ < look_back::kReadings) continue;
      length = std::abs(taken_[i]);
      grid_ = period;
    }
  }

  static constexpr std::int64_t kMillisecond = 1000000;                                          ///< [ns]
  static constexpr std::array<std::int64_t, 11> kPeriods{2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20};  ///< [ms]
  static constexpr double kRecognised = 0.5;  ///< by chance once in exp(100)
  static constexpr double kDivides = 0.1;     ///< share of a period up to which an interval counts as whole periods
  static constexpr double kMost = 0.5;        ///< share of the mean interval by which one may differ from it
  static constexpr double kFew = 10.0;        ///< intervals
  static constexpr double kLongest = 0.1;     ///< [s]
  static constexpr double kOften = 0.2, kStuck = 0.98;

  RunningMean<> step_{look_back::kReadings}, repeats_{look_back::kReadings};
  std::array<std::complex<double>, kPeriods.size()> taken_{};  ///< mean of exp(2 pi i instant/period)
  double readings_{};                                          ///< in it
  double grid_{};                                              ///< period of the grid [s]; 0: none
  std::int64_t last_{};                                        ///< stamp [ns]
};

}  // namespace hammer_loads
