/// Run of the simulated machine with its hull on its boom.
#pragma once

#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation::test {

inline MachineSettings onBoom() {
  MachineSettings m = workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.duration = 4.0;
  m.drive.start_time = 0.7;
  m.drive.stop_time = 9.0;
  m.on_boom.on = true;
  m.on_boom.imu = {500.0, 0.1, 0.2, 0.3, 0.0, 0.0};
  m.on_boom.pressures = {100.0, 0.0, 5e6};
  return m;
}

}  // namespace hammer_loads::simulation::test
