#include "hammer_loads/pipeline/step_wrenches.h"

#include "hammer_loads/pipeline/channel_values.h"

namespace hammer_loads {
namespace {

using Components = std::array<double, kHullChannels>;

/// Where in (0, 1) the cubic with these values at 0 and 1 and slopes of opposite signs has its extreme.
double extremeOfCubic(double value_0, double value_1, double slope_0, double slope_1) noexcept {
  // slope(s) = a s^2 + b s + slope_0
  const double rise = value_1 - value_0;
  const double a = 3.0 * (slope_0 + slope_1 - 2.0 * rise), b = 6.0 * rise - 4.0 * slope_0 - 2.0 * slope_1;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * slope_0));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double s = slope_0 / q;
  return s > 0.0 && s < 1.0 ? s : q / a;
}

void insert(double time, ExtremeInstants& sorted) noexcept {
  std::size_t place = sorted.count++;
  for (; place > 0 && sorted.time[place - 1] > time; --place) sorted.time[place] = sorted.time[place - 1];
  sorted.time[place] = time;
}

}  // namespace

ExtremeInstants extremeInstants(const StepLoad& load, const CrankStep& step, const SmoothSpan& span) noexcept {
  constexpr double kNear = 1e-3;  // of the span: where slopes are looked at
  const double length = span.to - span.from;
  const auto at = [&](const CrankEstimate& crank) {
    Components values;
    wrenchValues(load.at(crank), values.data());
    return values;
  };
  const Components from = at(span.begin), after = at(step.at(span.from + kNear * length));
  const Components before = at(step.at(span.to - kNear * length)), to = at(span.finish);
  ExtremeInstants result;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double slope_0 = (after[i] - from[i]) / kNear, slope_1 = (to[i] - before[i]) / kNear;
    if (!(slope_0 * slope_1 < 0.0)) continue;
    const double place = extremeOfCubic(from[i], to[i], slope_0, slope_1);
    if (place > 0.0 && place < 1.0) insert(span.from + place * length, result);
  }
  return result;
}

}  // namespace hammer_loads
