/// Sources of a boom's loads, by their quality.
#pragma once

namespace hammer_loads {

enum class Known {
  kGiven,     ///< the vibration is that of the file's oil under the hammer's load
  kFollowed,  ///< readings show the vibration
  kMeasured,  ///< pressures in all cylinders give torques and the rock's force as well
};

}  // namespace hammer_loads
