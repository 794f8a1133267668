/// Warnings of what the crank's readings show of their sensor at once: speeds that are filtered, a zero that slipped.
#pragma once

#include <vector>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/warnings.h"

namespace hammer_loads {

void warnOfReadings(const CrankFollower& crank, const CrankFilter& filter, std::vector<Warning>& warnings);

}  // namespace hammer_loads
