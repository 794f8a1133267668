/// Cost table, first part: what a way to the loads costs and how many digits it keeps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/bench/load_errors.h"
#include "hammer_loads/bench/timing.h"

namespace hammer_loads::accuracy {

struct CaseError {
  std::string name;  ///< of the hard case
  Error error;
};

struct CostRow {
  std::string group;  ///< printed, scalar, batch, crank, pipeline, life or grapple
  std::string name;
  Cost cost;
  std::vector<CaseError> errors;   ///< against the reference of the row's own level; none where sessions show it
  std::optional<double> left_out;  ///< regular turn, Fz against the reference of level linkage, of the peak
};

}  // namespace hammer_loads::accuracy
