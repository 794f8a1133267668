/// Settings of the log from its parameter file.
#pragma once

#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {

/// Usable only if the reader got no problem.
LogSettings readLogSettings(ParameterReader& reader);

}  // namespace hammer_loads
