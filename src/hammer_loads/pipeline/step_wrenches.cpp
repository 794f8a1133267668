#include "hammer_loads/pipeline/step_wrenches.h"

#include "hammer_loads/pipeline/channel_values.h"

namespace hammer_loads {
namespace {

constexpr double kNear = 1e-3;    // part of the span at which slopes are evaluated
constexpr double kClearly = 1.5;  // 1 would suffice for slopes on a line along the span
// Numerical: kClearly
constexpr double kHardly = 1e-3;  // negligible relative change of a component
// Numerical: kNear, kHardly

using Components = std::array<double, kHullChannels>;

/// Returns the position of the extreme in (0, 1) of a cubic from its values and slopes (of opposite signs) at 0 and 1.
double extremeOfCubic(double value_0, double value_1, double slope_0, double slope_1) noexcept {
  // slope(s) = a s^2 + b s + slope_0
  const double rise = value_1 - value_0;
  const double a = 3.0 * (slope_0 + slope_1 - 2.0 * rise), b = 6.0 * rise - 4.0 * slope_0 - 2.0 * slope_1;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * slope_0));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double s = slope_0 / q;
  return s > 0.0 && s < 1.0 ? s : q / a;
}

/// Returns the crank extrapolated by its own motion; the angle stays on its side of a blow.
CrankEstimate moved(CrankEstimate crank, double time, double jerk) noexcept {
  crank.position.angle.offset += time * crank.speed;
  crank.speed += time * crank.acceleration;
  crank.acceleration += time * jerk;
  return crank;
}

void insert(double time, ExtremeInstants& sorted) noexcept {
  std::size_t place = sorted.count++;
  for (; place > 0 && sorted.time[place - 1] > time; --place) sorted.time[place] = sorted.time[place - 1];
  sorted.time[place] = time;
}

/// Returns true if every component clearly rises or falls all along a span. after, before: values slightly within the
/// span due to the motion at its ends alone. A sample's correction on the way adds nearly equally to both slopes: it is
/// the rise of the components beyond the slopes.
bool risesOrFalls(const Components& from, const Components& after, const Components& before,
                  const Components& to) noexcept {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double slope_0 = (after[i] - from[i]) / kNear, slope_1 = (to[i] - before[i]) / kNear;
    const double rise = to[i] - from[i], corrected = rise - 0.5 * (slope_0 + slope_1);
    const double uncertainty = std::abs(slope_1 - slope_0) + std::abs(corrected) + kHardly * std::abs(to[i]);
    if (!(std::abs(rise) >= kClearly * uncertainty)) return false;
  }
  return true;
}

}  // namespace

ExtremeInstants extremeInstants(const StepLoad& load, const CrankStep& step, const SmoothSpan& span) noexcept {
  const double length = span.to - span.from, near = kNear * length;
  const auto at = [&](const CrankEstimate& crank) {
    Components values;
    wrenchValues(load.at(crank), values.data());
    return values;
  };
  const Components from = at(span.begin), to = at(span.finish);
  ExtremeInstants result;
  const double jerk = (span.finish.acceleration - span.begin.acceleration) / length;
  const bool at_blow = span.begin.position.angle.offset == 0.0 || span.finish.position.angle.offset == 0.0;
  const bool turns_on = span.begin.speed * span.finish.speed > 0.0;
  if (turns_on && !at_blow &&
      risesOrFalls(from, at(moved(span.begin, near, jerk)), at(moved(span.finish, -near, jerk)), to))
    return result;
  const Components after = at(step.at(span.from + near)), before = at(step.at(span.to - near));
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double slope_0 = (after[i] - from[i]) / kNear, slope_1 = (to[i] - before[i]) / kNear;
    if (!(slope_0 * slope_1 < 0.0)) continue;
    const double place = extremeOfCubic(from[i], to[i], slope_0, slope_1);
    if (place > 0.0 && place < 1.0) insert(span.from + place * length, result);
  }
  return result;
}

}  // namespace hammer_loads
