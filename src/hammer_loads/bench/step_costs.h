/// Cost of one crank sample of a working session: the step of the filter, and the whole pipeline.
#pragma once

#include <vector>

#include "hammer_loads/bench/cost_row.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// At 1 kHz; errors are the session table's. Some 5 s.
std::vector<CostRow> stepCosts(const Settings& settings);

}  // namespace hammer_loads::accuracy
