/// Warnings of sensor faults from their own readings: filtered speeds, a slipped zero, an IMU.
#pragma once

#include <vector>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/warnings.h"

namespace hammer_loads {

void warnOfReadings(const CrankFollower& crank, const CrankFilter& filter, std::vector<Warning>& warnings);
/// Warns of hull pitch and hull_imu.
void warnOfHull(const Pipeline& pipeline, const SampleCounts& counts, std::vector<Warning>& warnings);

}  // namespace hammer_loads
