/// The crank's messages of a recording, with the weight at each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/util/progress.h"

namespace hammer_loads {

/// Part of a recording that is read: pieces of `length`, evenly spread over it, or all of it.
struct ReadPieces {
  std::size_t count{6};
  double length{20.0};  ///< [s]: some eighty blows, so that neighbours are neighbours
  /// Twice as many.
  ReadPieces more() const { return {2 * count, length}; }
};

struct CrankBag {
  std::string problem;  ///< one line why it could not be read
  std::vector<calibration::RecordedSample> samples;
  bool pitch_known{};  ///< every pitch joint was heard
  bool whole{};        ///< all of it was read
};

/// In record order; time is the header stamp less that of the first message. A recording that is not much longer than
/// the pieces together is read completely. Topics and joints as in the settings.
CrankBag readCrankBag(const BagInputs& inputs, const Settings& settings, const ReadPieces& pieces,
                      const Progress& progress = {});

}  // namespace hammer_loads
