/// Diagnostics that survive the end of ROS time.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/console.h>

#include <exception>

namespace hammer_loads {

/// The updater adds its period to the time now, which throws in the last second before 2^32 s; a /clock may say anything.
inline void reportNow(diagnostic_updater::Updater& updater) {
  try {
    updater.force_update();
  } catch (const std::exception& error) {
    ROS_WARN_ONCE("/clock: %u s, must be some seconds below 2^32: no diagnostics (%s)", ros::Time::now().sec,
                  error.what());
  }
}

}  // namespace hammer_loads
