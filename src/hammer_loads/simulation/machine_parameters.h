/// The simulated machine's parameter file.
#pragma once

#include <string>

#include "hammer_loads/settings/parameter_map.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::simulation {

/// Settings of the machine's time relative to other clocks.
struct PlaySettings {
  bool publish_clock{};
  double clock_factor{};         ///< simulated seconds per second, with publish_clock [-], > 0
  double wait_for_subscriber{};  ///< at most, before time 0 [s]
  std::string truth_prefix;      ///< prefix of TruthFiles; empty: none
};

struct SimulatorSettings {
  MachineSettings machine;  ///< start_stamp is left to the player; duration infinite for a file's 0
  PlaySettings play;
};

/// Settings by the given parameters over config_directory's simulated_machine.yaml and, if no hammer key is given, its
/// hammer_mo100.yaml; or every problem, one line each.
Checked<SimulatorSettings> loadSimulator(const std::string& config_directory, const ParameterMap& given);

}  // namespace hammer_loads::simulation
