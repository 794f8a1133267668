/// The hammer file: one mechanism, every key required but `drive_reaction_ratio`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

class ParameterReader;

/// Nothing when the reader got a problem with it; notes get the mechanism's accepted peculiarities.
std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes);

/// Keys that the hammer file must have, in its order.
std::vector<std::string> hammerKeys();

bool hasHammerKey(const ParameterMap& parameters);

}  // namespace hammer_loads
