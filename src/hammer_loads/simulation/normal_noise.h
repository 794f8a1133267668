/// Seeded noise that is the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {

/// Box-Muller on mt19937_64, whose sequence is standardized, unlike that of std::normal_distribution.
class NormalNoise {
 public:
  explicit NormalNoise(std::uint64_t seed) : engine_(seed) {}

  /// Returns a standard normal deviate. Always consumes two numbers of the generator.
  double operator()() noexcept {
    const double u = 1.0 - uniform();  // (0, 1]
    const double v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(kTwoPi * v);
  }

  /// Returns a uniform deviate in [0, 1).
  double uniform() noexcept { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace hammer_loads::simulation
