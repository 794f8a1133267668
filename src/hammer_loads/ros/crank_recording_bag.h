/// The crank's messages of a bag, with the hull's pitch at each.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

struct CrankBag {
  std::string problem;  ///< one line why it could not be read
  std::vector<calibration::RecordedSample> samples;
  bool pitch_known{};  ///< every pitch joint was heard
};

/// In record order; time is the header stamp less that of the first message.
CrankBag readCrankBag(const std::vector<std::string>& files, const std::string& crank_topic,
                      const std::string& joint_topic, const PipelineSettings& settings);

}  // namespace hammer_loads
