/// Run of the simulated machine to which tests add flaws.
#pragma once

#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation::test {

inline MachineSettings flawedRun() {
  MachineSettings s = workingMo100();
  s.duration = 8.0;
  s.drive.start_time = 0.7;
  s.drive.stop_time = 20.0;
  s.step = 1e-4;  // for a balance to ten digits
  return s;
}

}  // namespace hammer_loads::simulation::test
