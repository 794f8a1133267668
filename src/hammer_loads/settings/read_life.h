/// Settings of the load cycles from their parameter file.
#pragma once

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {

/// Usable only if the reader got no problem. Whether the machine has the channels is LifeRecorder::make()'s to judge.
life::LifeSettings readLifeSettings(ParameterReader& reader);

}  // namespace hammer_loads
