/// Waits for the effects of other processes without sleeping.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <functional>

namespace hammer_loads::test {

/// Spins until the condition holds. Returns false if it still does not after some seconds [s] of wall time. What is
/// waited for takes milliseconds: only a hanging process exceeds the limit, however busy the computer is.
inline bool eventually(const std::function<bool()>& condition, double seconds = 120.0) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(seconds);
  while (!condition()) {
    if (ros::WallTime::now() > deadline || !ros::ok()) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(1e-3));
  }
  return true;
}

}  // namespace hammer_loads::test
