/// Pump and valves of the simulated drive.
#pragma once

#include "hammer_loads/simulation/machine_settings.h"

namespace hammer_loads::simulation {

/// Returns the flow of the pump at a time since the start [m3/s].
double supplyFlow(const DriveSettings& drive, double time) noexcept;
/// Returns the flow [m3/s] of leakage, relief valve and bypass; below zero pressure a check valve refills the line.
double valveFlow(const DriveSettings& drive, double time, double pressure) noexcept;
/// Returns the motor torque less friction on the shaft [N m], at a shaft speed [rad/s].
double netTorque(const DriveSettings& drive, double pressure, double speed) noexcept;

}  // namespace hammer_loads::simulation
