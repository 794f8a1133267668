/// How far a number of a turn may be off.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "hammer_loads/pipeline/hull_deviation.h"

namespace hammer_loads {

/// By constants, one standard deviation each of errors that are independent of each other (order of LoadColumns), the
/// same in all turns; and by what is drawn anew in each turn.
struct NumberError {
  using Columns = Eigen::Matrix<double, 1, kLoadColumns>;

  Columns columns{Columns::Zero()};  ///< unit of the number
  double own{};                      ///< standard deviation, as above

  double common() const noexcept { return columns.norm(); }
  double deviation() const noexcept { return std::hypot(own, common()); }
};

/// Of a HalfSinePulse.
struct PulseErrors {
  NumberError amplitude, impulse, turn_impulse_x, turn_impulse_z;
};

/// Of a RockerBlow.
struct BlowErrors {
  NumberError restitution, energy, tool_impulse_z, support_impulse_z;
};

}  // namespace hammer_loads
