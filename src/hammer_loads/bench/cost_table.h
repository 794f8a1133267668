/// Cost table, first part, as text.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/bench/cost_row.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// Every row, for the given hammer and the shipped grapple of the paper's claims. Some 20 s. Throws
/// std::runtime_error when the grapple's file cannot be used.
std::vector<CostRow> costTable(const Settings& settings);

/// As tables in Markdown: cost and worst errors, errors by hard case, tracking, grapple.
std::string markdown(const std::vector<CostRow>& rows);
/// As a JSON array of objects; an error that is no number is null.
std::string json(const std::vector<CostRow>& rows);

}  // namespace hammer_loads::accuracy
