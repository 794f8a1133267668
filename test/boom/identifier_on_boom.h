/// A mode identifier on the shipped boom, without any pipeline.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "boom/booms.h"
#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::test {

/// Within a factor of 1.25.
inline void expectAround(double value, double said) {
  EXPECT_GT(value, 0.8 * said);
  EXPECT_LT(value, 1.25 * said);
}

class IdentifierOnBoom : public testing::Test {
 protected:
  IdentifierOnBoom() : boom_(*Boom::make(shippedUrdf(), shippedBoomParameters()).value) {
    boom_.moveCompliant({workingPosition(), kZero, kZero}, kLevel);
    boom_.vibration().rest();
    boom_.moveCompliant({workingPosition(), kZero, kZero}, kLevel);
    modes_ = boom_.vibration().modes();
  }
  ModeIdentifier identifier(double damping = 0.07, bool learns = true) const {
    ModeIdentifier found(damping, learns);
    found.setModes(modes_);
    return found;
  }
  /// Without any force.
  void wait(ModeIdentifier& found, double time, double step = 1e-3) const {
    const JointVector none = JointVector::Zero(modes_.count);
    for (int i = 0; i < std::lround(time / step); ++i) found.advance(step, {none, none, none});
  }
  /// A reading that says nothing, of a clock.
  static void hear(ModeIdentifier& found, Clock clock) {
    VibrationReading reading = jointAngleReading(1, 0.0);
    reading.channel = 0, reading.clock = clock, reading.noise = 1e9, reading.offset_deviation = 1.0;
    found.observe(&reading, 1);
  }
  double accelerationDeviation(const ModeIdentifier& found, int mode) const {
    return std::sqrt(found.accelerationCovariance()(mode, mode));
  }

  Boom boom_;
  BoomModes modes_;
};

}  // namespace hammer_loads::test
