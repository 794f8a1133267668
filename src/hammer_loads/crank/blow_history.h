/// Factors of this machine's blows so far, as the prior of the next one.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// Mean and spread of the blows' factors, the last ten or so counting most. A machine whose blows are all alike needs
/// no samples to know the next one; one whose blows differ keeps the doubt that it needs.
class BlowHistory {
 public:
  explicit BlowHistory(const BlowPrior& first) noexcept
      : first_(first),
        mean_(kLength, first.mean, kFirstCounts),
        variance_(kLength, first.deviation * first.deviation, kFirstCounts),
        by_error_(kLength, ConstantErrors::Row::Zero(), kFirstCounts) {}

  /// factor of a blow, its variance and its derivative by the sensor's errors, by all samples since.
  void add(double factor, double variance, const ConstantErrors::Row& by_error) noexcept {
    const double doubt = square(gate::kUsual) * variance;
    if (!(doubt < variance_.mean() || variance < square(kLeast))) return;  // nothing was learned of it
    variance_.add(square(factor - mean_.mean()));
    mean_.add(factor);
    by_error_.add(by_error);
  }

  BlowPrior prior() const noexcept {
    return {mean_.mean(), std::clamp(std::sqrt(variance_.mean()), std::min(kLeast, first_.deviation), kMost),
            by_error_.mean()};
  }

 private:
  /// Blows; a wrong conclusion from the first few shows at once where the first guess counts little.
  static constexpr double kFirstCounts = 0.1, kLength = 10.0 + kFirstCounts;
  static constexpr double kLeast = 0.01;  // deviation
  static constexpr double kMost = 0.3;
  BlowPrior first_;
  RunningMean<> mean_, variance_;
  RunningMean<ConstantErrors::Row> by_error_;
};

}  // namespace hammer_loads
