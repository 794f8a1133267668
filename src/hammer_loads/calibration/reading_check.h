/// Checks of readings: pressures exchanged or in another unit, a joint's sensor that is faulty.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/boom_model.h"

namespace hammer_loads::calibration {

/// One line per cylinder whose pressures agree with the given boom only under another interpretation, or not at all,
/// and per joint beyond its limits. The forces of the given boom must be right within a half, as those of a drawing
/// are. Empty without a finding.
std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording);

/// One line per joint's sensor whose noise in one recording is far above that in the others; names: of the recordings.
std::vector<std::string> noisySensors(const Chain& chain, const std::vector<BoomPoints>& recordings,
                                      const std::vector<std::string>& names);

}  // namespace hammer_loads::calibration
