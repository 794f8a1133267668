#include "hammer_loads/pipeline/channel_values.h"

#include <algorithm>
#include <limits>

namespace hammer_loads {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void channelValues(const SampleResult& result, const HullWrench& wrench_deviation, const Boom* boom,
                   double* values, double* deviations) noexcept {
  wrenchValues(result.wrench, values);
  wrenchValues(wrench_deviation, deviations);
  if (boom == nullptr) return;
  double *value = values + kHullChannels, *deviation = deviations + kHullChannels;
  const auto joints = static_cast<std::size_t>(boom->chain().joints()), cylinders = boom->cylinders().size();
  std::fill_n(deviation, joints + cylinders, kNaN);
  if (result.boom == nullptr || result.boom->fault) {
    std::fill_n(value, joints + cylinders, kNaN);
    return;
  }
  const BoomLoads& loads = result.boom->loads;
  for (std::size_t i = 0; i < joints; ++i) *value++ = loads.total[static_cast<Eigen::Index>(i)];
  for (std::size_t i = 0; i < cylinders; ++i) *value++ = loads.cylinder[i].force;
}

}  // namespace hammer_loads
