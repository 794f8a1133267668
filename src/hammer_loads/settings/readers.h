/// Readers of the parameter files of the hammer, the boom, the load cycles with the names of a machine's loads
/// (topic/field or topic/name/field), and the log. Their results are usable only if the reader has no problem.
///
/// Every key of the hammer file is required, except those that kHammerConstants marks as optional. Every key of the
/// boom file is required, except `sections` and those of friction, sensor offsets, weighed links and standard
/// deviations. With `cylinders: []`, only `root_link` and `tip_link` are required. Then the keys of the oil are given
/// together or not at all, and so are those of the supports.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/log/log_settings.h"
#include "hammer_loads/settings/parameter_map.h"
#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {

/// Reads the boom file. `cylinders` and `sections` list names, with which the keys of each begin. The keys of a
/// section's part beyond (such as NAME_section_mass_beyond_kg) are given together or not at all. The result is usable
/// only if the reader has no problem; Boom::make() checks the values against each other and the chain.
BoomParameters readBoomParameters(ParameterReader& reader);

/// Returns true if any key of a boom file is given that does not belong to a single cylinder.
bool hasBoomKey(const ParameterMap& parameters);

/// Returns the boom file's keys among parameters in force, in the form of Settings::yaml: one `key: value` a line.
std::string boomYaml(const std::string& parameters);

/// Returns the mechanism; empty if the reader has a problem with it. notes receives its accepted peculiarities.
std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes);

/// Returns the keys that the hammer file must have, in its order.
std::vector<std::string> hammerKeys();

/// Returns keys and values [the key's unit] of the standard deviations in force, including those that no file gives.
std::vector<std::pair<std::string, double>> deviationsInForce(const HammerParameters& parameters);

bool hasHammerKey(const ParameterMap& parameters);

/// Reads the settings, usable only if the reader has no problem. checkChannels() then checks the channels.
life::LifeSettings readLifeSettings(ParameterReader& reader);

/// Adds a problem for each counted channel that is not among the machine's.
void checkChannels(const life::LifeSettings& settings, const std::vector<std::string>& of_machine,
                   ParameterReader& reader);

/// Removes from the shipped parameters the keys of channels that are not in the given life_channels, since they would
/// be unknown keys.
void leaveOutUnwantedChannels(const ParameterMap& given, ParameterMap& shipped);

/// Returns every channel that turn loads, load cycles and ledger may have, in the order of channelValues(). boom: null
/// if its loads are not known.
std::vector<std::string> channelNames(const Boom* boom);

/// Reads the settings, which are usable only if the reader has no problem.
LogSettings readLogSettings(ParameterReader& reader);

}  // namespace hammer_loads
