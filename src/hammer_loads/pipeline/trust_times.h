/// Over which times a sensor is judged by its mean.
#pragma once

namespace hammer_loads::trust {

constexpr double kMemory = 2.0, kLeastTime = 0.5;  ///< [s]
constexpr double kLongest = 0.05;                  ///< that one reading counts for, over a gap as well [s]
// Guard: SensorBounds.OfPressuresTimes of kMemory, kLeastTime, kLongest

}  // namespace hammer_loads::trust
