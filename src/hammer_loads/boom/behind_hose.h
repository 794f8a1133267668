/// Torques of the oil as pressures show them whose sensors sit behind hoses.
#pragma once

#include <cmath>

#include "hammer_loads/boom/mode_history.h"

namespace hammer_loads {

/// Per mode a lag of first order over the oil's torque, by its time constant [s].
struct BehindHose {
  ModeVector torque = ModeVector::Zero(), rate = torque;  ///< modal; and by the second, over the last step

  /// Over a step [s] in which the oil's torque goes along a line.
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
