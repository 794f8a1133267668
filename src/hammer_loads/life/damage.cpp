#include "hammer_loads/life/damage.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::life {

namespace {

/// by_absolute, by_relative: of the figure, by a unit of the ranges' deviation and by a part of them.
Figure figureOf(double value, double by_absolute, double by_relative, const RangeDeviation& range) {
  const double own = std::hypot(by_absolute * range.absolute, by_relative * range.own);
  const double common = by_relative * range.common;
  return {value, std::isnan(common) ? own : std::hypot(own, common), common};
}

}  // namespace

Figure equivalentLoad(const std::vector<RangeMean>& cycles, double slope, double equivalent_cycles,
                      const RangeDeviation& range) {
  double largest = 0.0;
  for (const RangeMean& c : cycles) largest = std::max(largest, c.range);
  if (largest == 0.0) return {0.0, std::isnan(range.absolute) ? range.absolute : 0.0, 0.0};
  double sum = 0.0, derivative = 0.0;  // in units of the largest range: no overflow, no underflow
  for (const RangeMean& c : cycles) {
    const double power = std::pow(c.range / largest, slope - 1.0);
    sum += c.count * power * (c.range / largest);
    derivative += c.count * power;
  }
  const double value = largest * std::pow(sum / equivalent_cycles, 1.0 / slope);
  return figureOf(value, value * derivative / (sum * largest), value, range);
}

Checked<SnCurve> SnCurve::make(double knee_range, double knee_cycles, double slope, double slope_below) {
  Checked<SnCurve> result;
  const auto positive = [&](const char* name, double value, const char* unit) {
    if (!(std::isfinite(value) && value > 0.0))
      result.problems.push_back(format("%s: %.17g%s, must be a finite number > 0", name, value, unit));
  };
  positive("sn_knee_range_MPa", knee_range, " MPa");
  positive("sn_knee_cycles", knee_cycles, "");
  positive("sn_slope", slope, "");
  if (!(std::isfinite(slope_below) && slope_below >= slope))
    result.problems.push_back(
        format("sn_slope_below: %.17g, must be a finite number >= sn_slope (%.17g)", slope_below, slope));
  if (result.problems.empty()) result.value = SnCurve(knee_range, knee_cycles, slope, slope_below);
  return result;
}

double SnCurve::damage(double range) const { return std::pow(range / knee_range_, slopeAt(range)) / knee_cycles_; }

// FKM: R > 1, R <= 0, 0 < R < 1/2 and R >= 1/2, with R = (mean - amplitude)/(mean + amplitude) written as limits of the
// mean.
FkmMeanStress::Equivalent FkmMeanStress::atAlternating(double amplitude, double mean) const {
  const double m = sensitivity, beyond = (1.0 + m) / (1.0 + m / 3.0);
  if (mean < -amplitude) return {amplitude * (1.0 - m), 1.0 - m};
  if (mean <= amplitude) return {amplitude + m * mean, 1.0};
  if (mean < 3.0 * amplitude) return {beyond * (amplitude + m / 3.0 * mean), beyond};
  return {beyond * (1.0 + m) * amplitude, beyond * (1.0 + m)};
}

Figure damage(const std::vector<RangeMean>& cycles, const SnCurve& curve, const std::optional<FkmMeanStress>& mean,
              const RangeDeviation& deviation) {
  double sum = 0.0, by_absolute = 0.0, by_relative = 0.0;
  for (const RangeMean& c : cycles) {
    FkmMeanStress::Equivalent at{0.5 * c.range, 1.0};
    if (mean) at = mean->atAlternating(0.5 * c.range, c.mean);
    if (!(at.amplitude > 0.0)) continue;
    const double range = 2.0 * at.amplitude, each = curve.damage(range);
    const double derivative = c.count * each * curve.slopeAt(range) / range * at.derivative;
    sum += c.count * each;
    by_absolute += derivative;
    by_relative += derivative * c.range;
  }
  return figureOf(sum, by_absolute, by_relative, deviation);
}

Figure remainingHours(const Figure& damage, double hours) {
  if (!(damage.value > 0.0)) return {kInfinity, kNaN, kNaN};
  const double life = hours / damage.value;
  const double by_damage = life / damage.value;
  return {std::max(0.0, life - hours), by_damage * damage.deviation, by_damage * damage.common};
}

}  // namespace hammer_loads::life
