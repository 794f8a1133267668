/// From parameter files to checked settings.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/linkage/checked.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/parameters/log_settings.h"
#include "hammer_loads/parameters/parameter_map.h"
#include "hammer_loads/parameters/pipeline_settings.h"

namespace hammer_loads {

struct Settings {
  Mechanism mechanism;
  PipelineSettings pipeline;
  LogSettings log;
  std::string yaml;                ///< every parameter in force; loading it alone gives the same settings
  std::vector<std::string> notes;  ///< accepted peculiarities, one line each
};

/// Settings from what was given over what is shipped in `config_directory`, or every problem at once, one line each.
///
/// Pipeline and log: each key given replaces the shipped one. Hammer: physical parameters have no defaults, so a single
/// hammer key given means that all must be; with none given hammer_mo100.yaml is used.
Checked<Settings> load(const std::string& config_directory, const ParameterMap& given);

/// The same from files; a later file's key replaces an earlier one's.
Checked<Settings> loadFiles(const std::string& config_directory, const std::vector<std::string>& files);

/// Where the shipped files are: beside the installed program or library, else in the source tree it was built from.
std::string configDirectory();

}  // namespace hammer_loads
