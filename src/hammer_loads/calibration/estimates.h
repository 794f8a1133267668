/// Results of a calibration: keys to write, and notes for the user on constants that hide each other.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/calibration/hammer_part.h"

namespace hammer_loads::calibration {

/// Constants that are better known than by their file, each with the key of its deviation, and the rod that closes the
/// linkage with them.
std::vector<Estimate> estimatesOf(const HammerPart& hammer, const HammerParameters& file);

/// Constant, or level, whose uncertainty makes most of that of a shared parameter; empty: the noise does. by_blows:
/// covariance of the shared parameters with the constants as given.
std::string hiddenBy(const HammerPart& hammer, const GlobalMatrix& by_blows, Eigen::Index parameter);

/// Notes for the user: shared parameters that the constants hide, and constants that show only in combination with
/// others. by_blows: covariance of the shared parameters with the constants as given.
std::vector<std::string> remarksOf(const HammerPart& hammer, const GlobalMatrix& by_blows,
                                   const HammerParameters& file);

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
