#include "hammer_loads/simulation/drive.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

/// Rises from 0 before to 1 after, with a continuous slope.
double rise(double time, double from, double length) noexcept {
  const double x = std::clamp((time - from) / length, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

double supplyFlow(const DriveSettings& d, double time) noexcept {
  const double open = rise(time, d.start_time, d.start_ramp) * (1.0 - rise(time, d.stop_time, d.stop_ramp));
  return d.flow * open *
         (1.0 + d.flow_variation * std::sin(2.0 * kPi * time / d.flow_variation_period) +
          d.ripple * std::sin(2.0 * kPi * d.ripple_frequency * time));
}

double valveFlow(const DriveSettings& d, double time, double pressure) noexcept {
  const double bypass = pressure < 0.0 ? d.bypass : d.bypass * rise(time, d.stop_time, d.stop_ramp);
  return (d.leakage + bypass) * pressure + d.relief_slope * std::max(0.0, pressure - d.relief_pressure);
}

double netTorque(const DriveSettings& d, double pressure, double speed) noexcept {
  return d.motor_displacement * pressure - d.coulomb_friction * std::tanh(speed / d.friction_speed) -
         d.viscous_friction * speed;
}

}  // namespace hammer_loads::simulation
