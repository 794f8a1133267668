/// Readings of one sensor that waited for one bus and came together.
#pragma once

#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// No sensor of a machine is read more often than this [s].
constexpr double kSameInstant = 1e-4;

/// Of stamps of one sensor, one after the other: their difference is the bus's, and no rate can be found over it.
inline bool cameTogether(StampNs before, StampNs after) noexcept { return seconds(after - before) < kSameInstant; }

}  // namespace hammer_loads
