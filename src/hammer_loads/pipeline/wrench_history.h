/// The hammer's load over the step between two crank samples, cut where blows lie.
#pragma once

#include <array>
#include <cstddef>

#include "hammer_loads/hammer/hammer_model.h"

namespace hammer_loads {

/// A part of the step in which no blow lies. Wrenches come from motion of links and drive relative to the hull: without
/// weight, without what the hull's own motion does to them.
struct SmoothPiece {
  double duration{};    ///< [s] >= 0
  HullWrench from, to;  ///< at its ends
  HullWrench mean;      ///< over it, exact by the momentum difference
  bool ends_in_blow{};
  HullWrench blow;    ///< impulse of that blow BY links and drive ON the hull about D [N s, N s, N m s]
  double blow_std{};  ///< standard deviation of that blow's instant [s]
};

/// The pieces of one step in order of time; none after a restart, when the step before the sample is not known.
struct WrenchHistory {
  std::size_t count{};
  std::array<SmoothPiece, 5> pieces;

  double length() const noexcept {  ///< [s]
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += pieces[i].duration;
    return sum;
  }
};

}  // namespace hammer_loads
