/// Checked settings from parameter files.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/settings/input_topics.h"
#include "hammer_loads/settings/limits.h"
#include "hammer_loads/settings/parameter_map.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

struct Settings {
  Mechanism mechanism;
  PipelineSettings pipeline;
  LogSettings log;
  life::LifeSettings life;  ///< every channel that it names is one of this machine
  std::vector<Limit> limits;
  std::optional<Boom> boom;        ///< nothing: `boom: none`, no robot description, or one without the boom's links
  bool hammer_given{};             ///< true if hammer parameters are given; otherwise the shipped MO-100 is used
  std::string robot_description;   ///< the URDF's text, as given
  std::string yaml;                ///< every parameter in force; loading it alone with the same robot description
                                   ///< gives the same settings
  std::string machine;             ///< hammer and boom parameters and robot description: equal for the same machine.
                                   ///< The drive's inertia is left out, since `calibrate` finds a better one
  std::vector<std::string> notes;  ///< accepted peculiarities, one line each
  InputTopics input_topics;        ///< topics, also at the end of `yaml`
};

/// Returns the settings from the given parameters over those shipped in `config_directory`. Otherwise returns every
/// problem at once, one line each.
Checked<Settings> load(const std::string& config_directory, ParameterMap given,
                       const std::string& robot_description = {});

/// Returns the settings from files; a later file's key replaces an earlier one's.
Checked<Settings> loadFiles(const std::string& config_directory, const std::vector<std::string>& files,
                            const std::string& robot_description = {});

/// Returns the settings in force with some numbers changed, or the reason why they are invalid. The keys must be among
/// those in force.
Checked<Settings> withChanges(const Settings& settings, const std::vector<std::pair<std::string, double>>& changes);

/// Returns the settings with the names of the topics from which the input comes.
Settings withInputTopics(Settings settings, const InputTopics& topics);

/// Returns the settings from a run_info, which another version of this package may have written. parameters_yaml: every
/// parameter in force when it was written. A pipeline or log key that this version does not know is ignored. A known
/// key that is missing has the value shipped in `config_directory`. A note names each. Notes of the parameters
/// themselves are in the settings alone.
Checked<Settings> loadRecorded(const std::string& config_directory, const std::string& parameters_yaml,
                               const std::string& robot_description);

/// Returns the parameters of a run_info; nothing, with the reason in `problems`, if it is no YAML map.
std::optional<ParameterMap> recordedParameters(const std::string& parameters_yaml, std::vector<std::string>& problems);

struct ParameterText {
  std::string key, value;
  std::optional<std::string> shipped;  ///< value in the shipped files, if one has the key
};

/// Returns the parameters in force as texts, from Settings::yaml, sorted by key. Equal values have equal texts.
/// config_directory: directory of the shipped files.
std::vector<ParameterText> parameterTexts(const std::string& config_directory, const std::string& yaml);

/// Returns the shipped files' directory: beside the installed program or library, else in the source tree of the build.
std::string configDirectory();

}  // namespace hammer_loads
