/// Lateness of the stamps that real drivers give.
#pragma once

#include <cmath>

#include "hammer_loads/simulation/normal_noise.h"

namespace hammer_loads::simulation {

/// A driver polls its device by a clock of its own and stamps when it finds a reading: stamps are the next tick of that
/// clock, so that their lateness is a sawtooth of the beat between the two clocks. A few come much later.
struct DriverStamps {
  double tick{};        ///< period of the driver's clock [s]; 0: each reading is stamped at once
  double late_share{};  ///< part of the stamps that are late beside that [-], in [0, 1]
  double late_mean{};   ///< mean of their lateness, which is distributed exponentially [s]

  bool areExact() const noexcept { return tick == 0.0 && late_share == 0.0; }
  /// Lateness of the stamp of a reading taken at `time` [s]. Always consumes two numbers of the generator.
  double lateness(double time, NormalNoise& draws) const noexcept {
    const double beat = tick > 0.0 ? tick * std::ceil(time / tick) - time : 0.0;
    const bool late = draws.uniform() < late_share;
    const double more = -late_mean * std::log(1.0 - draws.uniform());
    return beat + (late ? more : 0.0);
  }
};

}  // namespace hammer_loads::simulation
