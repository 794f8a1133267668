/// Whether a recording is of a machine whose rod gives: what a rigid one explains is then no zero.
#pragma once

#include <string>

#include "hammer_loads/calibration/calibration.h"
#include "hammer_loads/crank/consistency.h"

namespace hammer_loads::calibration {

/// What the crank's filter finds with the sensor and the drive of a fit.
RodEvidence rodEvidence(const CrankTrack& track, const CalibrationBasis& basis, const JointFit& fit);

/// By how much, just after the blow and later.
std::string whereReadingsDiffer(const RodEvidence& rod);

/// That it gives, and what to do. settled: a fit by the hammer file's links did; else they may be other ones.
std::string whatARodDoes(const RodEvidence& rod, bool settled);

/// Keys that a rigid rod's fit would get wrong are not determined: how far they may be off, and what to do instead.
/// ratio: encoder turns per crank turn.
void refuseForRod(const RodEvidence& rod, double ratio, Calibration& result);

}  // namespace hammer_loads::calibration
