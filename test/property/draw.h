/// Random machines and states of their cranks.
#pragma once

#include <random>

#include "hammer_loads/hammer/hull_model.h"
#include "support/mo100.h"

namespace hammer_loads::test {

constexpr int kMachines = 100000;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  std::size_t index(std::size_t size) { return std::uniform_int_distribution<std::size_t>(0, size - 1)(random_); }
  /// Returns parameters whose rod deviates from the change-point condition by up to the permitted tolerance.
  HammerParameters parameters() {
    HammerParameters p = randomParameters(random_);
    p.lengths.rod += 0.999e-3 * between(-1.0, 1.0) * p.lengths.crank;
    return p;
  }
  CrankAngle angle() { return CrankAngle::fromOffset(between(-kPi, kPi)); }
  CrankMotion crank() { return {angle(), between(-60.0, 60.0), between(-2000.0, 2000.0)}; }
  Gravity gravity() {
    const double pitch = between(-kPi, kPi);
    return {9.81 * std::sin(pitch), -9.81 * std::cos(pitch)};
  }

 private:
  std::mt19937 random_;
};

}  // namespace hammer_loads::test
