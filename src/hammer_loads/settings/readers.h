/// Readers of the parameter files: of the hammer, the boom, the load cycles with the names of a machine's loads
/// (topic/field or topic/name/field), and the log. Their results are usable only if the reader got no problem.
///
/// Every key of the hammer file is required but those that kHammerConstants names optional. Every key of the boom file
/// is required but `sections`, and those of friction, sensors' offsets, weighed links and deviations; with `cylinders:
/// []` so are only `root_link` and `tip_link`, and the keys of the oil and those of the supports each together or not
/// at all.
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

/// `cylinders` and `sections` name them; the keys of each begin with its name. The keys of a section's part beyond
/// (NAME_section_mass_beyond_kg and its like) are given together or not at all. Usable only if the reader has no
/// problem; Boom::make() checks the values against each other and the chain.
BoomParameters readBoomParameters(ParameterReader& reader);

/// Returns true if any key of a boom file is there that is not a cylinder's own.
bool hasBoomKey(const ParameterMap& parameters);

/// The boom file's keys of parameters in force, as Settings::yaml has them; one `key: value` a line.
std::string boomYaml(const std::string& parameters);

/// The mechanism; empty if the reader has a problem with it. notes receives the mechanism's accepted peculiarities.
std::optional<Mechanism> readMechanism(ParameterReader& reader, std::vector<std::string>& notes);

/// Keys that the hammer file must have, in its order.
std::vector<std::string> hammerKeys();

/// Keys and values [the key's unit] of the standard deviations in force, those that the file does not give among them.
std::vector<std::pair<std::string, double>> deviationsInForce(const HammerParameters& parameters);

bool hasHammerKey(const ParameterMap& parameters);

/// Usable only if the reader got no problem; checkChannels() then judges whether the machine has its channels.
life::LifeSettings readLifeSettings(ParameterReader& reader);

/// A problem for each counted channel that is not among the machine's.
void checkChannels(const life::LifeSettings& settings, const std::vector<std::string>& of_machine,
                   ParameterReader& reader);

/// Removes from the shipped parameters the keys of channels that are not in the given life_channels, since they would
/// be unknown keys.
void leaveOutUnwantedChannels(const ParameterMap& given, ParameterMap& shipped);

/// Every channel that turn loads, load cycles and ledger may have, in the order of channelValues(). boom: null where
/// its loads are not known.
std::vector<std::string> channelNames(const Boom* boom);

/// Usable only if the reader got no problem.
LogSettings readLogSettings(ParameterReader& reader);

}  // namespace hammer_loads
