/// Cost of the straight-line grapple: warm step and cold start.
#pragma once

#include <vector>

#include "hammer_loads/bench/cost_row.h"
#include "hammer_loads/grapple/grapple.h"

namespace hammer_loads::accuracy {

/// Errors of the jaw edge P, dP/ds and d2P/ds2 over the stroke and 1e-2 to 1e-10 m before the fold or dead point above
/// it, against the explicit curve; relative ones to max(1, size). Some 2 s.
std::vector<CostRow> grappleCosts(const Grapple& grapple);

}  // namespace hammer_loads::accuracy
