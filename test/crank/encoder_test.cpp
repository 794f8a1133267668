#include "hammer_loads/crank/encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hammer_loads {
namespace {

/// Readings of an encoder of so many counts on a crank that turns a little unevenly.
template <typename Reading>
void turn(Encoder& encoder, int counts, double per_sample, const Reading& reading, int samples = 3000) {
  std::mt19937 random(counts);
  std::uniform_real_distribution<> uneven(0.7, 1.3);
  double angle = 0.3;
  for (int i = 0; i < samples; ++i, angle += per_sample * uneven(random)) {
    const double count = kTwoPi / counts;
    encoder.angle(reading(std::floor(angle / count) * count));
  }
}

TEST(EncoderCount, IsReadOffTheReadings) {
  for (const int counts : {90, 360, 1000, 1024, 2500, 4096, 10000, 16384, 65536}) {
    for (const double per_sample : {0.003, 0.04, 0.4}) {
      Encoder encoder(0.0);
      turn(encoder, counts, per_sample, [](double r) { return CrankAngle::wrapToPi(r) + 3.0; });
      EXPECT_TRUE(encoder.isKnown()) << counts;
      EXPECT_NEAR(kTwoPi / encoder.resolution(), counts, 1e-6 * counts) << per_sample;
    }
  }
}

TEST(EncoderCount, SurvivesSinglePrecisionAndAZeroOfItsOwn) {
  Encoder encoder(0.0);
  turn(encoder, 4096, 0.04,
       [](double r) { return static_cast<double>(static_cast<float>(std::fmod(r, kTwoPi) + 0.0123)); });
  EXPECT_NEAR(kTwoPi / encoder.resolution(), 4096, 1e-6);
}

/// A damaged message, at every part of a count, is no finer sensor.
TEST(EncoderCount, OutlivesAReadingThatFitsNothing) {
  for (int part = 1; part < 40; ++part) {
    for (const int damaged : {1, 2, 3}) {
      Encoder encoder(0.0);
      const auto plain = [](double r) { return r; };
      turn(encoder, 1000, 0.04, plain, 100);
      for (int i = 0; i < damaged; ++i) encoder.angle(1.0 + 0.7 * i * i + kTwoPi / 1000 * part / 40.0);
      EXPECT_TRUE(encoder.isKnown()) << part;
      turn(encoder, 1000, 0.04, plain, 100);
      EXPECT_TRUE(encoder.isKnown() && !encoder.isFiner()) << part;
      EXPECT_NEAR(kTwoPi / encoder.resolution(), 1000, 1e-3) << part;
    }
  }
}

TEST(EncoderCount, OutlivesASensorThatIsMoved) {
  Encoder encoder(0.0);
  for (const double moved : {0.0, 0.1234, 2.2, 0.00071}) {
    turn(
        encoder, 2048, 0.04, [&](double r) { return r + moved; }, 100);
    EXPECT_TRUE(encoder.isKnown() && !encoder.isFiner()) << moved;
    EXPECT_NEAR(kTwoPi / encoder.resolution(), 2048, 1e-3) << moved;
  }
}

/// All differences so far were multiples of five counts.
TEST(EncoderCount, IsFoundFinerThanItSeemed) {
  Encoder encoder(0.0);
  for (int i = 0; i < 60; ++i) encoder.angle(kTwoPi / 1000 * 5 * i);
  EXPECT_NEAR(kTwoPi / encoder.resolution(), 200, 1e-6);
  turn(
      encoder, 1000, 0.04, [](double r) { return r; }, 100);
  EXPECT_TRUE(encoder.isKnown());
  EXPECT_NEAR(kTwoPi / encoder.resolution(), 1000, 1e-3);
}

/// Nonsense for a while, then readings as before.
TEST(EncoderCount, ComesBackAfterNonsense) {
  Encoder encoder(0.0);
  const auto plain = [](double r) { return r; };
  turn(encoder, 4096, 0.04, plain, 100);
  for (int i = 0; i < 50; ++i) encoder.angle(std::fmod(std::sqrt(2.0 + i), kTwoPi));
  turn(encoder, 4096, 0.04, plain, 100);
  EXPECT_TRUE(encoder.isKnown() && !encoder.isFiner());
}

TEST(EncoderCount, IsContradictedIfItIsGivenWrong) {
  for (const int counts : {360, 1024, 4096}) {
    Encoder given(kTwoPi / 1024);
    EXPECT_FALSE(given.contradictsGiven());
    turn(given, counts, 0.04, [](double r) { return r; });
    EXPECT_EQ(given.contradictsGiven(), counts != 1024) << counts;
  }
  Encoder of_none(kTwoPi / 1024);
  for (int i = 0; i < 50; ++i) of_none.angle(std::sqrt(2.0 + i));
  EXPECT_TRUE(of_none.isFiner());
  EXPECT_TRUE(of_none.contradictsGiven());
}

using Step = EncoderSlip::Step;
constexpr double kVariance = 2.5e-7, kByTorque = 1e-3, kWay = 0.02;  // [rad2], [rad]

EncoderSlip quiet() {
  EncoderSlip slip;
  for (int i = 0; i < 10; ++i) slip.endTurn();
  slip.follow(1e-4, kVariance, kByTorque, kWay, 0.0, true);
  return slip;
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

}  // namespace
}  // namespace hammer_loads
