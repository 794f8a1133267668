/// Friction of the cylinders' seals, and oil torques as read by pressure sensors at the end of hoses.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/mode_history.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Friction against the rod's motion as a torque on the joint. The load on the joint is the oil's torque plus `way`,
/// from -1 to 1, times this torque. One part is known, the rest only by its standard deviation. Seals yield before
/// sliding: way' = (rate - |rate| way)/yielding (P. R. Dahl's model).
struct Seals {
  double known{}, deviation{};  ///< known part, and standard deviation of the rest [N m]
  double driven{};              ///< rate of the joint without its vibration [rad/s]
  double yielding{1.0};         ///< joint angle over which the seals yield before they slide [rad]

  /// Returns `way` after a time [s], to first order before it if negative; vibrating: rate of the vibration [rad/s].
  double wayAfter(double way, double vibrating, double time) const noexcept {
    const double turned = (driven + vibrating) * time / yielding, size = std::abs(turned);
    if (time < 0.0) return std::clamp(way + turned + size * way, -1.0, 1.0);
    const double end = turned < 0.0 ? -1.0 : 1.0;
    return end + (way - end) * std::exp(-size);
  }
};

/// Returns the seals of the boom file. arm [m/rad]; torque of the oil [N m]; driven: rate of the joint without its
/// vibration [rad/s].
inline Seals sealsOf(const Cylinder& cylinder, double arm, double oil_torque, double driven) noexcept {
  constexpr double kYielding = 3e-5;  // yielding displacement of a rod [m]
  // Prior: kYielding
  const CylinderParameters& p = cylinder.parameters();
  const double size = std::abs(arm), force = std::abs(oil_torque / arm);
  return {size * (p.friction_force + p.friction * force),
          size * std::sqrt(square(p.friction_force_std) + square(p.friction_std * force)), driven, kYielding / size};
}

/// Modal torques of the oil behind a hose: a first-order lag per mode with the time constant lag [s].
struct BehindHose {
  ModeVector torque = ModeVector::Zero(), rate = torque;  ///< modal torque and its rate over the last step

  /// Advances by a step [s] in which the oil's torque is linear in time.
  void follow(int mode, double step, double lag, double from, double to) noexcept {
    const double behind = lag * (to - from) / step, before = torque[mode];
    torque[mode] = to - behind + std::exp(-step / lag) * (before - from + behind);
    rate[mode] = (torque[mode] - before) / step;
  }
  /// Returns the torque at a time after the present, or before it if negative [s]. oil: present torque of the oil.
  double at(int mode, double ahead, double lag, double oil) const noexcept {
    if (ahead < 0.0) return torque[mode] + ahead * rate[mode];
    return torque[mode] + (1.0 - std::exp(-ahead / lag)) * (oil - torque[mode]);
  }
};

}  // namespace hammer_loads
