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
  double wait_for_subscriber{};  ///< longest wait before time 0 [s]
  std::string truth_prefix;      ///< prefix of TruthFiles; empty: none
};

struct SimulatorSettings {
  MachineSettings machine;  ///< the player sets start_stamp; duration 0 in the file means infinite
  PlaySettings play;
};

/// Returns the settings, or every problem, one line each. The given parameters override config_directory's
/// simulated_machine.yaml and, if no hammer key is given, its hammer_mo100.yaml.
Checked<SimulatorSettings> loadSimulator(const std::string& config_directory, const ParameterMap& given);

}  // namespace hammer_loads::simulation
