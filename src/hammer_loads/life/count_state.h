/// A count as text, to go on with later: every line checked on reading, a checksum at the end.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "hammer_loads/life/cycle_count.h"
#include "hammer_loads/life/exact_cycles.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

using Count = std::variant<CycleCount, ExactCycles>;

/// The same count gives the same text.
std::string stateText(const Count& count);

/// Anything else than a whole text of stateText() is a problem, of one line.
Checked<Count> countFromState(const std::string& text);

/// Whether a series gives these: classes on the grid, sorted, a residue without a cycle in it.
bool isPossible(const CycleCount& count);

}  // namespace hammer_loads::life
