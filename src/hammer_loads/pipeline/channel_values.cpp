#include "hammer_loads/pipeline/channel_values.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

double* put(const Wrench& wrench, double* place) noexcept {
  place = std::copy(wrench.force.begin(), wrench.force.end(), place);
  return std::copy(wrench.torque.begin(), wrench.torque.end(), place);
}

}  // namespace

void channelValues(const SampleResult& result, const HullWrench& wrench_deviation, const Boom* boom, double* values,
                   double* deviations) noexcept {
  wrenchValues(result.wrench, values);
  wrenchValues(wrench_deviation, deviations);
  if (boom == nullptr) return;
  double *value = values + kHullChannels, *deviation = deviations + kHullChannels;
  const auto joints = static_cast<std::size_t>(boom->chain().joints());
  const std::size_t cylinders = boom->cylinders().size(), sections = boom->sections().size();
  if (result.boom == nullptr || result.boom->fault) {
    std::fill_n(value, joints + cylinders + kSectionChannels * sections, kNaN);
    std::fill_n(deviation, joints + cylinders + kSectionChannels * sections, kNaN);
    return;
  }
  const BoomState& state = *result.boom;
  value = std::copy_n(state.loads.total.data(), joints, value);
  deviation = std::copy_n(state.deviations.torque.data(), joints, deviation);
  for (std::size_t i = 0; i < cylinders; ++i) *value++ = state.loads.cylinder[i].force;
  deviation = std::copy_n(state.deviations.cylinder.data(), cylinders, deviation);
  for (std::size_t i = 0; i < sections; ++i) {
    value = put(state.steel.section[i], value);
    deviation = put(state.deviations.section[i], deviation);
  }
}

}  // namespace hammer_loads
