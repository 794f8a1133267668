/// Pump and valves of the simulated drive.
#pragma once

#include "hammer_loads/simulation/machine_settings.h"

namespace hammer_loads::simulation {

/// Flow of the pump at a time since the start [m3/s].
double supplyFlow(const DriveSettings& drive, double time) noexcept;
/// Leakage, relief valve, bypass at a pressure [Pa]; below zero a check valve refills the line [m3/s].
double valveFlow(const DriveSettings& drive, double time, double pressure) noexcept;
/// Motor less friction at a shaft speed [rad/s], on the shaft [N m].
double netTorque(const DriveSettings& drive, double pressure, double speed) noexcept;

}  // namespace hammer_loads::simulation
