/// Checks of a joint's sensor by its own readings, and of readings against the given boom: exchanged pressures, units,
/// limits.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/calibration/boom_model.h"
#include "hammer_loads/calibration/boom_recording.h"

namespace hammer_loads::calibration {

/// Returns the noise of a joint sensor in each recording, rms over all instants, over the median of the others [-].
std::vector<double> noiseRatios(const std::vector<BoomPoints>& recordings, int joint);

/// Returns one line per joint sensor whose noise in one recording is far above the others; names: of the recordings.
std::vector<std::string> noisySensors(const Chain& chain, const std::vector<BoomPoints>& recordings,
                                      const std::vector<std::string>& names);

/// Returns one line per joint sensor that jumps between two readings and stays there, or whose reading stays exactly
/// equal although it is noisy elsewhere. No joint moves like that. names: of the recordings.
std::vector<std::string> brokenSensors(const Chain& chain, const std::vector<const BoomRecording*>& recordings,
                                       const std::vector<std::string>& names);

/// Returns one line per cylinder whose pressures agree with the given boom only under another interpretation, or not at
/// all, and per joint beyond its limits. The forces of the given boom must be right within a half, as those of nominal
/// parameters are. Empty without a finding.
std::vector<std::string> misreadings(const BoomModel& model, const BoomPoints& recording);

}  // namespace hammer_loads::calibration
