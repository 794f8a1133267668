/// The grapple file: one linkage, every key required.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads {

class ParameterReader;

/// Nothing when the reader got a problem with it.
std::optional<Grapple> readGrapple(ParameterReader& reader);

/// The grapple alone from files; a later file's key replaces an earlier one's. Unknown keys are problems.
Checked<Grapple> loadGrapple(const std::vector<std::string>& files);

}  // namespace hammer_loads
