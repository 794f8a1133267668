/// Conversion of header stamps between ROS and the pipeline.
#pragma once

#include <ros/time.h>

#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

inline ros::Time timeOf(StampNs stamp) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(stamp));
  return time;
}

inline StampNs stampOf(const ros::Time& time) { return static_cast<StampNs>(time.toNSec()); }

}  // namespace hammer_loads
