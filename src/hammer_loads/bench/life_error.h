/// How far the damage-equivalent range of an estimated load is from that of the true one.
#pragma once

#include "hammer_loads/life/damage.h"
#include "hammer_loads/life/exact_cycles.h"

namespace hammer_loads::accuracy {

constexpr double kLifeSlope = 5.0;  ///< of the S-N line; damage errs about this many times as much

/// Both series sample by sample; cycles counted by ASTM E1049, without a grid.
struct LifeError {
  life::ExactCycles estimated, right;
  void add(double estimate, double truth) { estimated.add(estimate), right.add(truth); }
  /// Relative, > 0: too large.
  double error() const { return equivalentRange(estimated) / equivalentRange(right) - 1.0; }

 private:
  static double equivalentRange(const life::ExactCycles& cycles) {
    return life::equivalentLoad(life::rangesAndMeans(cycles), kLifeSlope, 1.0, {}).value;
  }
};

}  // namespace hammer_loads::accuracy
