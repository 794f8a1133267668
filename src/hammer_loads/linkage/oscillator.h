/// A damped oscillator without a load.
#pragma once

#include <cmath>

namespace hammer_loads {

/// y'' = -square y - 2 decay y', exactly over a time, with any damping.
struct Oscillator {
  double square{};  ///< of its free frequency [rad2/s2], > 0
  double decay{};   ///< [1/s], >= 0

  void move(double time, double& y, double& speed) const noexcept {
    const double rest = square - decay * decay, from = y, v = speed;
    double cosine, sine;  // sine over the frequency, both with the decay
    if (rest > 0.0) {
      const double frequency = std::sqrt(rest), e = std::exp(-decay * time);
      cosine = e * std::cos(frequency * time), sine = e * std::sin(frequency * time) / frequency;
    } else {
      const double s = std::sqrt(-rest);
      const double slow = std::exp((s - decay) * time), fast = std::exp(-(s + decay) * time);
      cosine = 0.5 * (slow + fast), sine = s > 0.0 ? 0.5 * (slow - fast) / s : time * slow;
    }
    y = from * cosine + (v + decay * from) * sine;
    speed = v * cosine - (square * from + decay * v) * sine;
  }
};

}  // namespace hammer_loads
