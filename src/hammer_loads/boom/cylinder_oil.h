/// Oil and seals of the cylinders: torques as pressure sensors at the end of hoses read them, and the seals' friction.
#pragma once

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/mode_history.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Friction against the rod's motion, as a torque on the joint: the joint's load is that of the oil and `way`, from -1
/// to 1, times this torque. One part of it is known, the other only by its standard deviation. The seals yield before
/// they slide: way' = (rate - |rate| way)/yielding (P. R. Dahl's model).
struct Seals {
  double known{}, deviation{};  ///< standard [N m]
  double driven{};              ///< rate of the joint beside its vibration [rad/s]
  double yielding{1.0};         ///< turn of the joint before the seals slide [rad]

  /// Later or, to first order, earlier `way` of a joint that vibrates with a rate [rad/s].
  double wayAfter(double way, double vibrating, double time) const noexcept {
    const double turned = (driven + vibrating) * time / yielding, size = std::abs(turned);
    if (time < 0.0) return std::clamp(way + turned + size * way, -1.0, 1.0);
    const double end = turned < 0.0 ? -1.0 : 1.0;
    return end + (way - end) * std::exp(-size);
  }
};

/// Seals by the boom file. arm [m/rad]; torque of the oil [N m]; driven: rate of the joint without its vibration
/// [rad/s].
inline Seals sealsOf(const Cylinder& cylinder, double arm, double oil_torque, double driven) noexcept {
  constexpr double kYielding = 3e-5;  // of a rod [m]
  // Prior: kYielding
  const CylinderParameters& p = cylinder.parameters();
  const double size = std::abs(arm), force = std::abs(oil_torque / arm);
  return {size * (p.friction_force + p.friction * force),
          size * std::sqrt(square(p.friction_force_std) + square(p.friction_std * force)), driven, kYielding / size};
}

/// First-order lag of the oil's torque, one per mode, with its time constant [s].
struct BehindHose {
  ModeVector torque = ModeVector::Zero(), rate = torque;  ///< modal torque and its rate over the last step

  /// Advances by a step [s] in which the oil's torque is linear in time.
  void follow(int mode, double step, double lag, double from, double to) noexcept {
    const double behind = lag * (to - from) / step, before = torque[mode];
    torque[mode] = to - behind + std::exp(-step / lag) * (before - from + behind);
    rate[mode] = (torque[mode] - before) / step;
  }
  /// Torque at a time after the present, or before it if negative [s]; oil: its torque at present.
  double at(int mode, double ahead, double lag, double oil) const noexcept {
    if (ahead < 0.0) return torque[mode] + ahead * rate[mode];
    return torque[mode] + (1.0 - std::exp(-ahead / lag)) * (oil - torque[mode]);
  }
};

}  // namespace hammer_loads
