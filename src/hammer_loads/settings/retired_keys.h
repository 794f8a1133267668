/// Keys of earlier versions that a parameter file may still have.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

/// Takes them out of the parameters, so that no reader finds them unknown. A value that asks for what is gone gets a
/// line in `notes`.
void dropRetiredKeys(ParameterMap& parameters, std::vector<std::string>& notes);

}  // namespace hammer_loads
