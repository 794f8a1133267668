/// Pressures that are otherwise than said: exchanged or in another unit.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"

namespace hammer_loads::calibration {

/// One line per cylinder whose pressures fit the given boom only as something else, or not at all; and per joint beyond
/// its limits. A given boom is within half of the forces: a drawing's masses are. Empty: nothing found.
std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording);

}  // namespace hammer_loads::calibration
