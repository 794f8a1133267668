/// Cost table, second part: error of a whole session by sample rate and encoder.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/bench/session_errors.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

struct SessionRow {
  double rate{};  ///< rate of crank samples [Hz]
  int counts{};   ///< counts of the encoder per revolution
  bool speed{};   ///< speeds are measured too
  SessionErrors errors;
};

/// Simulated working sessions of the given hammer (seeded: the same on every run), some 20 s of computing.
std::vector<SessionRow> sessionTable(const Settings& settings);

/// Rows as a table in Markdown.
std::string markdown(const std::vector<SessionRow>& rows);
/// Rows as a JSON array of objects, errors as parts of one.
std::string json(const std::vector<SessionRow>& rows);

}  // namespace hammer_loads::accuracy
