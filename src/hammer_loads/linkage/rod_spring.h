/// What gives between crank and rocker.
#pragma once

#include "hammer_loads/util/constants.h"

namespace hammer_loads {

/// Rod, pins and bearings as one spring along the rod, its damping and the play of the pins.
struct RodSpring {
  double stiffness{};      ///< k [N/m]; 0: not known
  double damping_ratio{};  ///< of an oscillator of kReference on k [-]; 0: not known
  double play{};           ///< free way of both pins together [m], >= 0

  static constexpr double kReference = kTwoPi * 200.0;                                      ///< [rad/s]
  double damping() const noexcept { return 2.0 * damping_ratio * stiffness / kReference; }  ///< [N s/m]
};

}  // namespace hammer_loads
