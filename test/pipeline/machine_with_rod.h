/// The shipped hammer with a rod that gives, at work.
#pragma once

#include <cstdint>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/held_hull.h"

namespace hammer_loads::test {

inline const Settings& shippedDrawing() {
  static const Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  return settings;
}

inline simulation::MachineSettings machineWithRod(const simulation::RodSettings& rod, std::uint64_t seed) {
  simulation::MachineSettings s = simulation::workingMo100();
  s.hammer = shippedDrawing().mechanism.parameters();
  s.level = Level::kLinkage;
  s.duration = 13.0;
  s.drive.stop_time = 11.5;
  s.rod = rod;
  s.seed = seed;
  return s;
}

/// Stamps without jitter: a mean over whole steps ends at samples.
inline simulation::MachineSettings machineOfOutputs(const simulation::RodSettings& rod, std::uint64_t seed) {
  simulation::MachineSettings s = machineWithRod(rod, seed);
  s.crank.jitter = 0.0;
  s.crank.drop_outs.clear();
  return s;
}

}  // namespace hammer_loads::test
