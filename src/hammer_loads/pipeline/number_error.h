/// Uncertainty of a figure of a revolution.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hammer_loads/pipeline/hull_deviation.h"

namespace hammer_loads {

/// Errors due to constants: independent, one standard deviation each (order of LoadColumns), equal in all revolutions.
/// `own` is the standard deviation of errors that are independent in each revolution.
struct NumberError {
  using Columns = Eigen::Matrix<double, 1, kLoadColumns>;

  Columns columns{Columns::Zero()};  ///< unit of the number
  double own{};                      ///< standard deviation, see above
  double rod{};                      ///< part due to a possibly elastic rod

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
