/// The grapple and the settings of grapple_node and process_grapple, from parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/grapple/grapple.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/settings/parameter_map.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

class ParameterReader;

/// The grapple, every key of its file required. Nothing when the reader got a problem with it.
std::optional<Grapple> readGrapple(ParameterReader& reader);

/// The grapple alone from files; a later file's key replaces an earlier one's. Unknown keys are problems.
Checked<Grapple> loadGrapple(const std::vector<std::string>& files);

/// Source of the slider's acceleration, which a JointState does not carry.
enum class SliderAcceleration {
  kNone,        ///< neglected: accelerations are those of a slider at its present speed
  kDifference,  ///< difference of the last two velocities over the time between them: the value half a sample period
                ///< ago
};

struct GrappleSettings {
  Grapple grapple;
  std::string slider_joint;  ///< in the JointState
  SliderAcceleration acceleration{};
  double stale_after{};  ///< the slider is reported as stale after this time without a sample [s]
  LogSettings log;
  std::string yaml;  ///< every parameter in force; loading it alone gives the same settings
};

/// Settings from what was given over log.yaml and grapple_node.yaml in `config_directory`, or every problem at once,
/// one line each. A grapple has no default: each of its keys must be given.
Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory, const ParameterMap& given);

/// Settings from files; a later file's key replaces an earlier one's.
Checked<GrappleSettings> loadGrappleSettings(const std::string& config_directory,
                                             const std::vector<std::string>& files);

}  // namespace hammer_loads
