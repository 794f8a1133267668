/// A sample's loads as a row of numbers, in the order of channelNames().
#pragma once

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/pipeline/sample_result.h"

namespace hammer_loads {

constexpr std::size_t kHullChannels = 3;  ///< channels at the front: force_x, force_z, torque_y

inline void wrenchValues(const HullWrench& wrench, double* values) noexcept {
  values[0] = wrench.force_x, values[1] = wrench.force_z, values[2] = wrench.torque_y;
}

/// Values of all channels at an accepted sample; NaN: not known. boom: as for the names. All arrays have as many places
/// as there are names. The wrench's deviations are those of extremes at the sample; common: the part of constants in
/// these.
void channelValues(const SampleResult& result, const Boom* boom, double* values, double* deviations,
                   double* common) noexcept;

}  // namespace hammer_loads
