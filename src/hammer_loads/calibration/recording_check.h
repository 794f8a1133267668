/// Checks of recordings against each other: the sensor of a joint that is faulty in one of them.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_fit.h"

namespace hammer_loads::calibration {

/// The largest contradiction of a recording to the others; empty without one, or where they are fewer than three. It
/// begins with the joint and names the recording.
///
/// Each recording is predicted by a fit to the others, whose covariance, offsets by day and noise give the standard
/// deviation of that prediction. Beyond four of them a recording contradicts the others, beyond two if a sensor of its
/// joint has eight times the usual noise. A sensor that differs from itself in the other recordings by a constant or
/// in proportion to the angle is estimated as one more unknown. It contradicts beyond four standard deviations,
/// to which the spread of the other recordings contributes.
std::string contradictionOf(const BoomModel& model, const std::vector<BoomPoints>& recordings,
                            const std::vector<BoomRow>& rows, const BoomFit& fit,
                            const std::vector<std::string>& names);

}  // namespace hammer_loads::calibration
