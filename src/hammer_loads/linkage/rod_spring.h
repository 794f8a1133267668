/// What gives between crank and rocker.
#pragma once

namespace hammer_loads {

/// Rod, pins and bearings as one spring along the rod, its damping and the play of the pins.
struct RodSpring {
  double stiffness{};      ///< k [N/m]; 0: not known
  double damping_ratio{};  ///< of an oscillator of 200 Hz on k [-]: damping is 2 ratio k/(2 pi 200 Hz); 0: not known
  double play{};           ///< free way of both pins together [m], >= 0
};

}  // namespace hammer_loads
