/// Cost table, third part: error of a whole session on machines as they are, one flaw each or the usual ones together.
#pragma once

#include <cstdint>
#include <string>

#include "hammer_loads/bench/table.h"
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

/// Simulated working sessions with the mechanism's filter as shipped (seeded: the same on every run), some minute of
/// computing.
Table machineTable(const Settings& settings, const MachineChoice& choice = {});

}  // namespace hammer_loads::accuracy
