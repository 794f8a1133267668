/// The simulated machine with the hammer that the shipped files describe.
#pragma once

#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::test {

/// At work until half a second before the end of its duration [s].
inline simulation::MachineSettings shippedMachine(const Settings& shipped, double duration, std::uint64_t seed) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = shipped.mechanism.parameters();
  machine.duration = duration;
  machine.drive.stop_time = duration - 0.5;
  machine.seed = seed;
  return machine;
}

}  // namespace hammer_loads::test
