/// A ledger's figures as text, CSV and JSON.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/life/ledger_reader.h"

namespace hammer_loads {

/// For reading: a table of channels per epoch, then the days of each channel.
std::string lifeText(const std::vector<life::EpochReport>& epochs);

/// One line per epoch, channel and day, the totals with day `all`; a figure that does not exist is an empty cell.
std::string lifeCsv(const std::vector<life::EpochReport>& epochs);

/// Report as one JSON object; a figure that does not exist is null.
std::string lifeJson(const std::vector<life::EpochReport>& epochs);

}  // namespace hammer_loads
