/// Header stamps: the only time that the rooms without ROS know.
#pragma once

#include <cstdint>

namespace hammer_loads {

/// Header stamp [ns].
using StampNs = std::int64_t;

constexpr double kSecondsPerNs = 1e-9;
/// Last stamp that a message can carry [ns]: 2^32 - 1 whole seconds and the nanoseconds up to the next.
constexpr StampNs kLastStamp = 4294967295999999999;

/// Length of a time [s].
constexpr double seconds(StampNs length) noexcept { return static_cast<double>(length) * kSecondsPerNs; }

}  // namespace hammer_loads
