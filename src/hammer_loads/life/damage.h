/// Damage-equivalent loads of counted cycles, and damage by an S-N curve (Palmgren-Miner).
#pragma once

#include <optional>
#include <vector>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

/// Figure and its standard deviation in the same unit, with the part by constants, which more revolutions do not
/// reduce; NaN if the loads have no standard deviations.
struct Figure {
  double value{}, deviation{}, common{};
};

/// Range that, in `equivalent_cycles` cycles, does the damage of all cycles on a material of this slope:
/// L = (sum n r^m / N)^(1/m), r the range; 0 without cycles. The errors of all ranges are fully correlated: dL = L sum
/// n r^(m-1) dr / sum n r^m.
Figure equivalentLoad(const std::vector<RangeMean>& cycles, double slope, double equivalent_cycles,
                      const RangeDeviation& range);

/// Cycles to failure by stress range, a straight line of two slopes in log-log: N = N_knee (S_knee/S)^m with m =
/// `slope` above the knee and `slope_below` below it.
class SnCurve {
 public:
  /// Knee range > 0 [MPa], knee cycles > 0, slope > 0, slope_below >= slope (equal: one slope).
  static Checked<SnCurve> make(double knee_range, double knee_cycles, double slope, double slope_below);

  double kneeRange() const { return knee_range_; }    ///< stress range, twice the amplitude [MPa]
  double kneeCycles() const { return knee_cycles_; }  ///< [-]
  double slope() const { return slope_; }
  double slopeBelow() const { return slope_below_; }

  /// Damage of one cycle of this range [MPa], as a part of the life.
  double damage(double range) const;
  /// Slope at this range.
  double slopeAt(double range) const { return range >= knee_range_ ? slope_ : slope_below_; }

 private:
  SnCurve(double knee_range, double knee_cycles, double slope, double slope_below)
      : knee_range_(knee_range), knee_cycles_(knee_cycles), slope_(slope), slope_below_(slope_below) {}
  double knee_range_, knee_cycles_, slope_, slope_below_;
};

/// Mean stress by the FKM guideline, with sensitivity M and M2 = M/3 beyond R = 0.
struct FkmMeanStress {
  double sensitivity{};  ///< M [-], >= 0

  /// Amplitude at R = -1 that does the same damage as this amplitude (>= 0) about this mean, and its derivative with
  /// respect to the amplitude.
  struct Equivalent {
    double amplitude{}, derivative{};
  };
  Equivalent atAlternating(double amplitude, double mean) const;
};

/// Sum of n/N over the cycles. With a mean-stress correction the curve must be one for R = -1. The ranges' deviations
/// are propagated linearly and are fully correlated.
Figure damage(const std::vector<RangeMean>& cycles, const SnCurve& curve, const std::optional<FkmMeanStress>& mean,
              const RangeDeviation& range);

/// Hours until the damage is 1 at the rate so far; infinite without damage, 0 when it is 1 already. `hours` > 0.
Figure remainingHours(const Figure& damage, double hours);

}  // namespace hammer_loads::life
