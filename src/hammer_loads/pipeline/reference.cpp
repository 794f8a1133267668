#include "hammer_loads/pipeline/reference.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {

void ReferenceComparison::Sums::add(double computed, double measured, double deviation) noexcept {
  const double step_c = computed - mean_computed, step_m = measured - mean_measured;
  ++count;
  within += std::abs(computed - measured) <= 2.0 * deviation;
  mean_computed += step_c / static_cast<double>(count);
  mean_measured += step_m / static_cast<double>(count);
  computed_square += step_c * (computed - mean_computed);
  measured_square += step_m * (measured - mean_measured);
  product += step_c * (measured - mean_measured);
}

void ReferenceComparison::measured(StampNs stamp, const Values& values) {
  ++received_;
  if (waiting_.size() == kKept) waiting_.pop_front(), ++left_out_;
  waiting_.push_back({stamp, values});
  match();
}

void ReferenceComparison::computed(StampNs stamp, const HullWrench& wrench, const HullWrench& deviation,
                                   bool continues) {
  if (received_ == 0) return;
  if (!computed_.empty() && stamp <= computed_.back().stamp) computed_.clear();
  if (computed_.size() == kKept) computed_.pop_front();
  computed_.push_back({stamp,
                       {wrench.force_x, wrench.force_z, wrench.torque_y},
                       {deviation.force_x, deviation.force_z, deviation.torque_y},
                       continues});
  match();
}

void ReferenceComparison::match() {
  while (!waiting_.empty() && !computed_.empty() && waiting_.front().stamp <= computed_.back().stamp) {
    const Measured measured = waiting_.front();
    waiting_.pop_front();
    const auto after = std::lower_bound(computed_.begin(), computed_.end(), measured.stamp,
                                        [](const Computed& c, StampNs stamp) { return c.stamp < stamp; });
    if (after->stamp == measured.stamp) {
      compare(*after, *after, measured);
    } else if (after != computed_.begin() && after->continues) {
      compare(*(after - 1), *after, measured);
    } else {
      ++left_out_;
    }
  }
}

void ReferenceComparison::compare(const Computed& before, const Computed& after, const Measured& measured) noexcept {
  const double step = seconds(after.stamp - before.stamp);
  const double part = step > 0.0 ? seconds(measured.stamp - before.stamp) / step : 1.0;
  for (std::size_t i = 0; i < kComponents; ++i) {
    if (!std::isfinite(measured.load[i])) continue;
    sums_[i].add(before.load[i] + part * (after.load[i] - before.load[i]), measured.load[i],
                 std::max(before.deviation[i], after.deviation[i]));
  }
}

ReferenceFigures ReferenceComparison::figures(std::size_t component) const {
  const Sums& sums = sums_[component];
  ReferenceFigures figures;
  figures.samples = sums.count;
  if (sums.count == 0) return figures;
  const auto count = static_cast<double>(sums.count);
  figures.bias = sums.mean_computed - sums.mean_measured;
  figures.rms = std::sqrt(sums.measured_square / count + sums.mean_measured * sums.mean_measured);
  const double square = (sums.computed_square + sums.measured_square - 2.0 * sums.product) / count;
  figures.rms_error = std::sqrt(std::max(0.0, square) + figures.bias * figures.bias);
  figures.scale = sums.product / sums.measured_square;
  figures.correlation =
      std::clamp(sums.product / std::sqrt(sums.computed_square * sums.measured_square), -1.0, 1.0);  // rounding
  figures.within_two_std = static_cast<double>(sums.within) / count;
  return figures;
}

}  // namespace hammer_loads
