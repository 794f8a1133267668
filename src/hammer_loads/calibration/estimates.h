/// Keys and notes for the user from a fit.
#pragma once

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/calibration/hammer_part.h"

namespace hammer_loads::calibration {

/// Results of the fits.
struct Found {
  const JointFit& fit;           ///< with the hammer's constants
  const GlobalMatrix& by_blows;  ///< covariance of the same, the constants as given
  const HammerPart& hammer;
  const CalibrationBasis& basis;
  bool centred{};  ///< no eccentricity was asked for
};

/// Sensor's place and drive, and which of them hang together.
void addEstimates(const Found& found, Calibration& result);

/// curve_square: mean over the turn of the residuals' curve over its deviation, squared; 1 for noise.
void addRemarks(double curve_square, Calibration& result);

}  // namespace hammer_loads::calibration
