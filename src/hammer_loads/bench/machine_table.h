/// Cost table, third part: error of a whole session on machines as they are, one flaw each or the usual ones together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/bench/session_run.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/machine_settings.h"

namespace hammer_loads::accuracy {

/// Sets typical sensor errors: zero half a degree off, 1024 counts, a PC's stamps, no speeds, blows that differ.
void makeTypical(simulation::MachineSettings& machine);

/// Machines of a table.
struct MachineChoice {
  std::string rows;           ///< regular expression that name and rate of a machine contain; empty: all of them
  std::uint64_t seed{kSeed};  ///< seed of the machines' random numbers
  bool speeds{true};          ///< false: only machines whose speeds are measured, without them
  static constexpr std::uint64_t kSeed = 77;

  bool has(const std::string& name) const;
};

struct MachineRow {
  std::string machine;
  double rate{};  ///< rate of crank samples [Hz]
  bool speed{};   ///< speeds are measured too
  SessionErrors errors;
};

/// Simulated working sessions with the mechanism's filter as shipped (seeded: the same on every run), some minute of
/// computing.
std::vector<MachineRow> machineTable(const Settings& settings, const MachineChoice& choice = {});

/// Rows as a table in Markdown.
std::string markdown(const std::vector<MachineRow>& rows);
/// Rows as a JSON array of objects, errors as parts of one.
std::string json(const std::vector<MachineRow>& rows);

}  // namespace hammer_loads::accuracy
