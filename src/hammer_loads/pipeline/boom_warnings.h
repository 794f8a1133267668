/// Warnings on sensors, oil and joints, derived from the boom's vibration.
#pragma once

#include <vector>

#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/warnings.h"

namespace hammer_loads {

/// Adds the warnings. boom: state at the last sample, nullptr if there is none. imu_lost: the IMU is not used.
void warnOfBoom(const BoomFollower& follower, const BoomState* boom, bool imu_lost, std::vector<Warning>& warnings);

}  // namespace hammer_loads
