/// Check whether the machine of a recording has an elastic rod: a zero fitted with a rigid one is then wrong.
#pragma once

#include <string>

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/crank/consistency.h"

namespace hammer_loads::calibration {

/// Evidence of the crank's filter, run with the sensor and the drive of a fit.
RodEvidence rodEvidence(const CrankTrack& track, const CalibrationBasis& basis, const JointFit& fit);

/// By how much, just after the blow and later.
std::string whereReadingsDiffer(const RodEvidence& rod);

/// Text that the rod is elastic, and the action. settled: a fit by the hammer file's links converged; else they may be
/// other ones.
std::string whatARodDoes(const RodEvidence& rod, bool settled);

/// Keys that a rigid rod's fit would get wrong are not determined: how far they may be off, and what to do instead.
/// ratio: encoder turns per crank turn.
void refuseForRod(const RodEvidence& rod, double ratio, Calibration& result);

}  // namespace hammer_loads::calibration
