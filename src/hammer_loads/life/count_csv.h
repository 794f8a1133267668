/// A count as CSV.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/life/cycle_count.h"

namespace hammer_loads::life {

/// Shortest of at most 17 significant digits that reads back as the same double.
std::string shortNumber(double value);

/// `range,mean,count`, one line for each; with the header alone when there is no cycle.
std::string csvText(const std::vector<RangeMean>& cycles);

}  // namespace hammer_loads::life
