/// Checks of recordings against each other for a joint sensor that is faulty in one of them.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_fit.h"

namespace hammer_loads::calibration {

/// Returns the largest contradiction of a recording to the others; empty if there is none, or fewer than three
/// recordings. The text begins with the joint and names the recording.
///
/// Each recording is predicted by a fit to the others. Their covariance, offsets by day and noise give the standard
/// deviation of the prediction. A recording contradicts the others beyond four standard deviations, or beyond two if a
/// sensor of its joint has eight times the usual noise. A sensor that differs from the other recordings by a constant
/// or in proportion to the angle is estimated as one more unknown. It contradicts beyond four standard deviations, to
/// which the spread of the other recordings contributes.
std::string contradictionOf(const BoomModel& model, const std::vector<BoomPoints>& recordings,
                            const std::vector<BoomRow>& rows, const BoomFit& fit,
                            const std::vector<std::string>& names);

}  // namespace hammer_loads::calibration
