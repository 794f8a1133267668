/// Cost of the loads of one state: printed formulas, every level, one by one and in batches.
#pragma once

#include <vector>

#include "hammer_loads/bench/cost_row.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::accuracy {

/// Some 10 s.
std::vector<CostRow> loadCosts(const Mechanism& mechanism);

}  // namespace hammer_loads::accuracy
