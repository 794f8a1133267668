/// Checks of readings against the given boom: pressures exchanged or in another unit, joints beyond limits.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"

namespace hammer_loads::calibration {

/// One line per cylinder whose pressures agree with the given boom only under another interpretation, or not at all,
/// and per joint beyond its limits. The forces of the given boom must be right within a half, as those of a drawing
/// are. Empty without a finding.
std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording);

}  // namespace hammer_loads::calibration
