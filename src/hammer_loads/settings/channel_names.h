/// Names of a machine's loads: topic/field or topic/name/field.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"

namespace hammer_loads {

/// Every channel that turn loads, load cycles and ledger may have, in the order of channelValues(). boom: null where
/// its loads are not known.
std::vector<std::string> channelNames(const Boom* boom);

}  // namespace hammer_loads
