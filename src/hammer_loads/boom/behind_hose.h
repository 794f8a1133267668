/// Oil torques as read by pressure sensors at the end of hoses.
#pragma once

#include <cmath>

#include "hammer_loads/boom/mode_history.h"

namespace hammer_loads {

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
