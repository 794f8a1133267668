/// Check whether the machine of a recording has an elastic rod: a zero fitted with a rigid one is then wrong.
#pragma once

#include <string>

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/crank/consistency.h"

namespace hammer_loads::calibration {

/// Returns the evidence of the crank filter, run with the sensor and the drive of a fit.
RodEvidence rodEvidence(const CrankTrack& track, const CalibrationBasis& basis, const JointFit& fit);

/// Returns the ratio of residuals to their expectation, just after the blow and later; with an elastic rod also its
/// effect and the action. settled: the fit with the hammer file's links converged; otherwise they may be wrong.
std::string textOf(const RodEvidence& rod, bool settled);

}  // namespace hammer_loads::calibration
