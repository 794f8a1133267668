/// The boom file: cylinders, damping, supports, sections. Every key is required but `sections`, and those of friction,
/// sensors' offsets, weighed links and deviations; with `cylinders: []` so
/// are only `root_link` and `tip_link`, and the keys of the oil and those of the supports each together or not at all.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/settings/parameter_map.h"

namespace hammer_loads {

class ParameterReader;

/// `cylinders` and `sections` name them; the keys of each begin with its name. The keys of a section's part beyond
/// (NAME_section_mass_beyond_kg and its like) are given together or not at all. Usable only if the reader has no
/// problem; Boom::make() checks the values against each other and the chain.
BoomParameters readBoomParameters(ParameterReader& reader);

/// Returns true if any key of a boom file is there that is not a cylinder's own.
bool hasBoomKey(const ParameterMap& parameters);

/// The boom file's keys of parameters in force, as Settings::yaml has them; one `key: value` a line.
std::string boomYaml(const std::string& parameters);

}  // namespace hammer_loads
