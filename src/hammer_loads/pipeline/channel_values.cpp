#include "hammer_loads/pipeline/channel_values.h"

#include <algorithm>

#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

constexpr std::size_t kSectionChannels =
    decltype(Wrench::force)::SizeAtCompileTime + decltype(Wrench::torque)::SizeAtCompileTime;

double* put(const Wrench& wrench, double* place) noexcept {
  place = std::copy_n(wrench.force.data(), 3, place);
  return std::copy_n(wrench.torque.data(), 3, place);
}

}  // namespace

void channelValues(const SampleResult& result, const Boom* boom, double* values, double* deviations,
                   double* common) noexcept {
  wrenchValues(result.wrench, values);
  wrenchValues(result.ofExtreme().deviation, deviations);
  wrenchValues(result.deviation.common, common);
  if (boom == nullptr) return;
  double* value = values + kHullChannels;
  const auto joints = static_cast<std::size_t>(boom->chain().joints());
  const std::size_t cylinders = boom->cylinders().size(), sections = boom->sections().size();
  if (result.boom == nullptr || result.boom->fault) {
    for (double* all : {values, deviations, common})
      std::fill_n(all + kHullChannels, joints + cylinders + kSectionChannels * sections, kNaN);
    return;
  }
  const BoomState& state = *result.boom;
  value = std::copy_n(state.loads.total.data(), joints, value);
  for (std::size_t i = 0; i < cylinders; ++i) *value++ = state.loads.cylinder[i].force;
  for (std::size_t i = 0; i < sections; ++i) value = put(state.steel.section[i], value);
  const auto putDeviations = [&](const BoomDeviations& of, double* place) {
    place = std::copy_n(of.torque.data(), joints, place);
    place = std::copy_n(of.cylinder.data(), cylinders, place);
    for (std::size_t i = 0; i < sections; ++i) place = put(of.section[i], place);
  };
  putDeviations(state.deviations, deviations + kHullChannels);
  putDeviations(state.common, common + kHullChannels);
}

}  // namespace hammer_loads
