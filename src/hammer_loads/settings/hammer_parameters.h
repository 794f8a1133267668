/// The hammer file: one mechanism, every key required but those that kHammerConstants names optional.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

class ParameterReader;

/// The mechanism; empty if the reader has a problem with it. notes receives the mechanism's accepted peculiarities.
std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes);

/// Keys that the hammer file must have, in its order.
std::vector<std::string> hammerKeys();

/// Keys and values [the key's unit] of the standard deviations in force, those that the file does not give among them.
std::vector<std::pair<std::string, double>> deviationsInForce(const HammerParameters& parameters);

bool hasHammerKey(const ParameterMap& parameters);

}  // namespace hammer_loads
