// Queue of forces for delayed sensors: the impulses taken equal those pushed, whatever the lengths of the pieces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_history.h"

namespace hammer_loads {
namespace {

/// A force that is a parabola over each step, and jumps at a blow.
class SomeForce {
 public:
  static constexpr double kStep = 1e-3, kBlow = 5e-3;
  static double at(double time) {
    const double step = std::min(std::floor(time / kStep + 1e-9), 19.0), u = time / kStep - step;
    return std::sin(7.0 * step) * 300.0 + 400.0 * u - 900.0 * std::cos(3.0 * step) * u * u;
  }
  /// Returns the impulse over a part of one step, by Simpson's rule, which is exact for a parabola.
  static double impulse(double from, double to) {
    const double inside = std::min(to, from + kStep) - 1e-11;
    return (to - from) / 6.0 * (at(from) + 4.0 * at(0.5 * (from + to)) + at(inside));
  }
  static TorqueStep step(int i) {
    const double from = kStep * i, to = kStep * (i + 1);
    const JointVector one = JointVector::Ones(3);
    return {at(from) * one, at(to - 1e-11) * one, impulse(from, to) / kStep * one};
  }
};

HeldForces held(int steps) {
  HeldForces held;
  for (int i = 0; i < steps; ++i) {
    held.push(SomeForce::kStep, SomeForce::step(i));
    if (SomeForce::kStep * (i + 1) == SomeForce::kBlow) held.strike(ModeVector::Constant(0.3));
  }
  return held;
}

TEST(HeldForces, GoOutAsTheyCameInWhateverTheLengths) {
  HeldForces forces = held(12);
  double time = 0.0, impulse = 0.0, wanted = 0.0;
  int blows = 0;
  for (const double most : {0.3e-3, 0.4e-3, 0.3e-3, 2.5e-3, 1e-3, 0.9e-3, 3e-3, 1.1e-3, 9e-3}) {
    const HeldForces::Piece piece = forces.take(most);
    EXPECT_LE(piece.duration, most * (1.0 + 1e-9));
    EXPECT_NEAR(piece.from[1], SomeForce::at(time), 1e-4) << time;
    EXPECT_NEAR(piece.to[1], SomeForce::at(time + piece.duration - 1e-11), 1e-4) << time;
    for (double begin = time, end = 0.0; begin < time + piece.duration - 1e-9; begin = end) {
      end = std::min(time + piece.duration, SomeForce::kStep * (std::floor(begin / SomeForce::kStep + 1e-6) + 1.0));
      wanted += SomeForce::impulse(begin, end);
    }
    time += piece.duration, impulse += piece.duration * piece.mean[1];
    EXPECT_NEAR(impulse, wanted, 1e-8) << time;
    if (piece.strikes) {
      EXPECT_NEAR(time, SomeForce::kBlow, 1e-12);
      EXPECT_EQ(piece.jump[2], 0.3);
      ++blows;
    }
  }
  EXPECT_EQ(blows, 1);
  EXPECT_TRUE(forces.empty());
  EXPECT_NEAR(time, 12e-3, 1e-11);
}

}  // namespace
}  // namespace hammer_loads
