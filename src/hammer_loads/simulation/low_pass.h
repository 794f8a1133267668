/// A low-pass of first order.
#pragma once

#include <cmath>

namespace hammer_loads::simulation {

/// lag y' = u - y; begins at rest, y = u. Between two inputs u is a straight line: exact for such.
class LowPass {
 public:
  /// lag [s], >= 0; 0: y is u.
  explicit LowPass(double lag) noexcept : lag_(lag) {}

  /// The input at `time` [s], never before the last one.
  void follow(double time, double input) noexcept {
    const double dt = time - time_;
    if (!begun_ || !(lag_ > 0.0)) {
      output_ = input;
    } else if (dt > 0.0) {
      const double behind = lag_ * (input - input_) / dt;  // of an input that has risen so for ever
      output_ = input - behind + (output_ - input_ + behind) * std::exp(-dt / lag_);
    }
    begun_ = true;
    time_ = time;
    input_ = input;
  }
  double output() const noexcept { return output_; }
  bool isOn() const noexcept { return lag_ > 0.0; }

 private:
  double lag_;
  bool begun_{};
  double time_{}, input_{}, output_{};
};

}  // namespace hammer_loads::simulation
