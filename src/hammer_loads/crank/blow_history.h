/// Factors of this machine's blows so far, as the prior of the next one.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {

/// Mean and variance of the blows' factors, weighted towards the last ten. If all blows of a machine are alike, the
/// next one is known before any sample; otherwise the variance remains as large as the scatter.
class BlowHistory {
 public:
  explicit BlowHistory(const BlowPrior& first) noexcept
      : first_(first),
        mean_(kLength, first.mean, kFirstCounts),
        variance_(kLength, first.deviation * first.deviation, kFirstCounts),
        by_error_(kLength, ConstantErrors::Row::Zero(), kFirstCounts) {}

  /// Takes the factor of a blow, its variance and its derivative by the sensor's errors, estimated from all samples
  /// since.
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
  /// Weight of the first guess in blows; a small weight lets a wrong conclusion from the first few blows show at once.
  static constexpr double kFirstCounts = 0.1, kLength = 10.0 + kFirstCounts;
  static constexpr double kLeast = 0.01;  // deviation
  static constexpr double kMost = 0.3;
  BlowPrior first_;
  RunningMean<> mean_, variance_;
  RunningMean<ConstantErrors::Row> by_error_;
};

}  // namespace hammer_loads
