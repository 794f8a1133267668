/// Settings of the load cycles from their parameter file.
#pragma once

#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {

/// Usable only if the reader got no problem; checkChannels() then judges whether the machine has its channels.
life::LifeSettings readLifeSettings(ParameterReader& reader);

/// A problem for each counted channel that is not among the machine's.
void checkChannels(const life::LifeSettings& settings, const std::vector<std::string>& of_machine,
                   ParameterReader& reader);

/// Removes from the shipped parameters the keys of channels that are not in the given life_channels, since they would
/// be unknown keys.
void leaveOutUnwantedChannels(const ParameterMap& given, ParameterMap& shipped);

}  // namespace hammer_loads
