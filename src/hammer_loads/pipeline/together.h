/// Readings of one sensor that waited for one bus and came together.
#pragma once

#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// No sensor of a machine is read more often than this [s].
constexpr double kSameInstant = 1e-4;

/// Returns true if two consecutive stamps of one sensor are too close for a rate: their difference comes from the bus.
inline bool cameTogether(StampNs before, StampNs after) noexcept { return seconds(after - before) < kSameInstant; }

}  // namespace hammer_loads
