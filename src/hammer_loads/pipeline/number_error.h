/// Uncertainty of a figure of a revolution.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/hull_deviation.h"

namespace hammer_loads {

/// Errors by constants, equal in all turns, one standard deviation each of independent errors (order of LoadColumns);
/// and the deviation of errors that are independent in each turn.
struct NumberError {
  using Columns = Eigen::Matrix<double, 1, kLoadColumns>;

  Columns columns{Columns::Zero()};  ///< unit of the number
  double own{};                      ///< standard deviation, as above
  double rod{};                      ///< the part of it by a possibly elastic rod

  /// Sets the rod's part where it is not known separately: the part of the deviation beyond that of readings alone.
  void setRodBeyond(double readings) noexcept { rod = std::sqrt(std::max(0.0, own * own - readings * readings)); }
  double common() const noexcept { return columns.norm(); }
  double deviation() const noexcept { return std::hypot(own, common()); }
};

/// Errors of a HalfSinePulse.
struct PulseErrors {
  NumberError amplitude, impulse, turn_impulse_x, turn_impulse_z;
};

/// Errors of a RockerBlow.
struct BlowErrors {
  NumberError restitution, energy, tool_impulse_z, support_impulse_z;

  void setRodBeyond(const BlowErrors& readings) noexcept {
    restitution.setRodBeyond(readings.restitution.own), energy.setRodBeyond(readings.energy.own);
    tool_impulse_z.setRodBeyond(readings.tool_impulse_z.own);
    support_impulse_z.setRodBeyond(readings.support_impulse_z.own);
  }
};

}  // namespace hammer_loads
