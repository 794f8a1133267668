/// Counted cycles and results of runs as NumPy arrays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hammer_loads/python/arrays.h"

namespace hammer_loads::python {

/// Load cycles of a series in its order, as the command count_cycles: arrays range, mean and count, by range, then by
/// mean; nan and inf are skipped. On a grid from LO to HI, or every value as it is.
py::dict countCycles(const py::object& series, const std::optional<std::pair<double, double>>& full_scale,
                     std::int64_t classes);

/// Every table of a database of process_bag --db, a ledger or the fleet: an array for each column. Whole numbers are
/// int64, float64 where one is missing; texts are an array of objects; what is missing is nan or None.
py::dict readDatabase(const std::string& path);

}  // namespace hammer_loads::python
