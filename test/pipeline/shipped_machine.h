/// Simulated machines with the hammer of the shipped files, also with an elastic connecting rod.
#pragma once

#include <cstdint>

#include "hammer_loads/bench/session_player.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"
#include "support/held_hull.h"

namespace hammer_loads::test {

/// Returns a machine that works until half a second before the end of its duration [s].
inline simulation::MachineSettings shippedMachine(const Settings& shipped, double duration, std::uint64_t seed) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.hammer = shipped.mechanism.parameters();
  machine.duration = duration;
  machine.drive.stop_time = duration - 0.5;
  machine.seed = seed;
  return machine;
}

inline const Settings& shippedDrawing() {
  static const Settings settings = test::heldHull(*load(configDirectory(), {}).value);
  return settings;
}

/// Plays a session into the shipped pipeline at a level.
inline accuracy::SessionPlayer shippedPlayer(const simulation::Session& session, Level level,
                                             OutputKind output = OutputKind::kInstantaneous, double output_rate = 0.0) {
  PipelineSettings settings = shippedDrawing().pipeline;
  settings.level = level, settings.output = output, settings.output_rate = output_rate;
  return accuracy::SessionPlayer(shippedDrawing().mechanism, settings, {}, session);
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

/// Returns a machine whose stamps do not jitter, so that a mean over whole steps ends at samples.
inline simulation::MachineSettings machineOfOutputs(const simulation::RodSettings& rod, std::uint64_t seed) {
  simulation::MachineSettings s = machineWithRod(rod, seed);
  s.crank.jitter = 0.0;
  s.crank.drop_outs.clear();
  return s;
}

}  // namespace hammer_loads::test
