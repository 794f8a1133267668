/// Joints' angles and cylinders' pressures of a recording.
#pragma once

#include <ros/time.h>

#include <string>

#include "hammer_loads/calibration/boom_recording.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads {

struct BoomBag {
  std::string problem;  ///< one line why it could not be read
  calibration::BoomRecording recording;
  ros::Time begin;     ///< traces count from this stamp
  std::string silent;  ///< joints without a cylinder and without a message, in one line; they are at zero
};

/// Topics, joints and cylinders as in the settings, which have a boom. Readings that are no numbers, or not newer than
/// the one before, are left out.
BoomBag readBoomBag(const BagInputs& inputs, const Settings& settings, const Progress& progress = {});

}  // namespace hammer_loads
