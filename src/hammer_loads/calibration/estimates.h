/// Results of a calibration: keys to write, and notes for the user on constants that hide each other.
#pragma once

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/calibration/hammer_part.h"
#include "hammer_loads/crank/consistency.h"

namespace hammer_loads::calibration {

/// Results of the fits.
struct Found {
  const JointFit& fit;  ///< fit with the hammer's constants as given
  const HammerPart& hammer;
  const CalibrationBasis& basis;
  const RodEvidence& rod;
  double curve_square{};  ///< mean square over a revolution of the residual curve over its deviation; 1 for noise
};

/// Adds the keys of sensor, drive and hammer, correlations and notes. A hammer constant and its deviation are added if
/// it is better known than by its file. If lengths are among them, the rod that closes the linkage is added.
void addResults(const Found& found, Calibration& result);

}  // namespace hammer_loads::calibration
