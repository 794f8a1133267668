// Which innovations are a slip of the encoder, and which are the crank's.
#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/crank/encoder.h"

namespace hammer_loads {
namespace {

using Step = EncoderSlip::Step;
constexpr double kVariance = 2.5e-7, kByTorque = 1e-3, kWay = 0.02;  // [rad2], [rad]

EncoderSlip quiet() {
  EncoderSlip slip;
  for (int i = 0; i < 10; ++i) slip.endTurn();
  slip.follow(1e-4, kVariance, kByTorque, kWay, 0.0, true);
  return slip;
}

/// Pushed at some time within the step: after the next one it is off by at least twice as much.
TEST(EncoderSlip, ACrankThatWasPushedIsNone) {
  for (const double part : {0.2, 0.6, 1.0}) {
    EncoderSlip slip = quiet();
    const double push = 20.0, dt = 1e-3;
    slip.follow(push * part * dt, kVariance, kByTorque, kWay, 0.0, true);
    EXPECT_NE(slip.follow(push * (part + 1.0) * dt, kVariance, kByTorque, kWay, kWay, true), Step::kSlipped) << part;
  }
}

TEST(EncoderSlip, IsNoModelThatFallsBehindGradually) {
  EncoderSlip slip = quiet();
  for (int i = 1; i < 40; ++i) EXPECT_EQ(slip.follow(-5e-4 * i, kVariance, kByTorque, kWay, 0.0, true), Step::kNone);
}

TEST(EncoderSlip, IsNeitherAClockThatWasSetNorASurpriseOfEachTurn) {
  for (const double set : {-1.0, -0.6, -0.4, 0.4, 0.6, 1.0}) {  // of what the innovation shows
    EncoderSlip one = quiet();
    const bool clock = std::abs(set) > 0.5;
    EXPECT_EQ(one.follow(0.035, kVariance, kByTorque, kWay, set * 0.035, true), clock ? Step::kNone : Step::kPerhaps);
    EncoderSlip next = quiet();
    EXPECT_EQ(next.follow(0.035, kVariance, kByTorque, kWay, 0.0, true), Step::kPerhaps);
    EXPECT_EQ(next.follow(0.035, kVariance, kByTorque, kWay, kWay + set * 0.035, true),
              clock ? Step::kNone : Step::kSlipped);
  }
  EncoderSlip slip = quiet();
  EXPECT_EQ(slip.follow(0.035, kVariance, kByTorque, kWay, -0.035, true), Step::kNone);
  EXPECT_EQ(slip.follow(1e-4, kVariance, kByTorque, kWay, 0.0, true), Step::kNone);
  slip.endTurn();
  EXPECT_EQ(slip.follow(0.035, kVariance, kByTorque, kWay, 0.0, true), Step::kNone);  // and the turn before
}

TEST(EncoderSlip, IsNoChangeThatTheTorqueCanCause) {
  EncoderSlip slip = quiet();
  EXPECT_EQ(slip.follow(0.035, kVariance, 0.04, kWay, 0.0, true), Step::kNone);
}

/// Half a turn further the sensor is another one.
TEST(EncoderSlip, IsNoSensorWithAnotherMounting) {
  for (const double step : {0.4, 0.625}) {
    EncoderSlip slip = quiet();
    EXPECT_EQ(slip.follow(step, kVariance, kByTorque, kWay, 0.0, true), step < 0.5 ? Step::kPerhaps : Step::kNone)
        << step;
  }
}

}  // namespace
}  // namespace hammer_loads
