// Forces that wait for the sensors' time: what goes out is what went in, whatever the lengths.
#include "hammer_loads/boom/held_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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
  /// Of a part of one step, by Simpson's rule, which is exact for it.
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

TEST(HeldForces, AreKnownAheadUpToTheLast) {
  const HeldForces forces = held(8);
  const ModeVector present = ModeVector::Constant(17.0);
  for (int i = 0; i < 8; ++i) {  // on the line between a step's ends
    const double begin = SomeForce::kStep * i,
                 line = 0.75 * SomeForce::step(i).from[0] + 0.25 * SomeForce::step(i).to[0];
    const Driven driven = forces.drivenAt(begin + 0.25 * SomeForce::kStep, present);
    EXPECT_NEAR(driven.force[0], line, 1e-9) << i;
    EXPECT_EQ(driven.jump[0], begin < SomeForce::kBlow - 1e-9 ? 0.0 : 0.3) << i;
  }
  EXPECT_NEAR(forces.drivenAt(1.0, present).force[0], SomeForce::step(7).to[0], 1e-9);
  EXPECT_EQ(HeldForces().drivenAt(1e-3, present).force, present);
}

/// A blow 0.2 ms ago and a force that jumps there, seen at an instant known to 0.5 ms and to 0.1 ms: half of the jump
/// is the line's, half is not; or it has been.
TEST(HeldForces, TreatABlowAsALineAndABendIfTheInstantIsUncertain) {
  ModeHistory past;
  const auto step = [&past](double length, double force) {
    past.begin(length);
    past.set(0, {}, {}, force, force);
  };
  step(1e-3, 100.0);
  past.strike(0, 0.4);
  step(0.2e-3, 160.0);
  const HeldForces none;
  const ModeVector present = ModeVector::Constant(160.0);
  const auto unsure = drivenAround(past, none, present, 0.0, 0.5e-3);
  ASSERT_TRUE(unsure);
  EXPECT_NEAR(unsure->velocity_rate[0], 0.4 / 1e-3, 1e-9);
  EXPECT_NEAR(unsure->force_rate[0], 60.0 / 1e-3, 1e-6);
  EXPECT_NEAR(unsure->velocity_bend[0], -0.2, 1e-11);
  EXPECT_NEAR(unsure->force_bend[0], -30.0, 1e-9);
  const auto sure = drivenAround(past, none, present, 0.0, 0.1e-3);
  EXPECT_EQ(sure->velocity_rate[0], 0.0);
  EXPECT_EQ(sure->force_bend[0], 0.0);
  EXPECT_FALSE(drivenAround(past, none, present, 0.0, 0.0));
}

TEST(HeldForces, AHistoryReachesAStepBeyondItsFirst) {
  ModeHistory past;
  EXPECT_TRUE(past.reaches(1.0)) << "nothing says so yet";
  for (int i = 0; i < 3; ++i) past.begin(1e-3);
  EXPECT_TRUE(past.reaches(3.9e-3));
  EXPECT_FALSE(past.reaches(4.1e-3));
}

}  // namespace
}  // namespace hammer_loads
