/// Warnings on sensors, oil and joints by the boom's vibration.
#pragma once

#include <vector>

#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/warnings.h"

namespace hammer_loads {

/// boom: of the last sample; nullptr: none. imu_lost: it is not used.
void warnOfBoom(const BoomFollower& follower, const BoomState* boom, bool imu_lost, std::vector<Warning>& warnings);

}  // namespace hammer_loads
