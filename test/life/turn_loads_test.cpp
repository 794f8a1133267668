// Minimum, maximum and mean load of a revolution compared with those of a known curve.
#include "hammer_loads/life/turn_loads.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::life {
namespace {

constexpr std::int64_t kMs = 1000000;

TEST(TurnLoads, AreThoseOfSamplesAndTheExtremesBetween) {
  TurnLoadsRecorder recorder(2);
  const double a[] = {1.0, 5.0}, b[] = {3.0, -2.0}, peak[] = {4.0, kNaN}, c[] = {2.0, 0.0};
  recorder.add(10 * kMs, a);
  recorder.add(20 * kMs, b);
  recorder.add(24 * kMs, peak);
  recorder.add(30 * kMs, c);
  const TurnLoads& turn = recorder.endTurn(34 * kMs);
  EXPECT_FALSE(turn.whole);
  EXPECT_EQ(turn.start, 10 * kMs);
  EXPECT_EQ(turn.end, 34 * kMs);
  const auto expect = [](const LoadExtreme& extreme, double value, std::int64_t instant) {
    EXPECT_EQ(extreme.value, value);
    EXPECT_EQ(extreme.instant, instant);
  };
  expect(turn.channels[0].minimum, 1.0, 10 * kMs);
  expect(turn.channels[1].minimum, -2.0, 20 * kMs);
  expect(turn.channels[0].maximum, 4.0, 24 * kMs);
  expect(turn.channels[1].maximum, 5.0, 10 * kMs);
  EXPECT_NEAR(turn.channels[0].mean, (20.0 + 14.0 + 18.0 + 8.0) / 24.0, 1e-14);
  EXPECT_NEAR(turn.channels[1].mean, (15.0 - 10.0 + 0.0) / 24.0, 1e-14);
}

// Samples 10 revolutions of a curve with a jump at the blow irregularly: min, max and mean are the curve's.
TEST(TurnLoads, MeanIsTheCurvesHoweverItIsSampled) {
  TurnLoadsRecorder recorder(1);
  const double period = 0.2;
  const auto curve = [&](double phase) { return 3.0 + 7.0 * phase * phase; };  // jumps from 10 to 3 at the blow
  double next_blow = period, before = 0.0;
  int turns = 0;
  for (int i = 0; turns < 10; ++i) {
    const double t = before + 5e-4 * (1.0 + 0.9 * std::sin(7.0 * i));
    before = t;
    if (t > next_blow) {
      const TurnLoads& turn = recorder.endTurn(static_cast<std::int64_t>(std::llround(1e9 * next_blow)));
      EXPECT_EQ(turn.whole, turns > 0);
      // A value is held for at most 0.95 ms at each end, with a slope of at most 70 1/s; trapezoidal rule: 3e-5.
      if (turn.whole) {
        EXPECT_NEAR(turn.channels[0].mean, 3.0 + 7.0 / 3.0, 70.0 * 0.95e-3 * 0.95e-3 / period + 3e-5);
      }
      EXPECT_NEAR(turn.channels[0].minimum.value, 3.0, 1e-3);
      EXPECT_NEAR(turn.channels[0].maximum.value, 10.0, 0.1);
      next_blow += period;
      ++turns;
    }
    const double value = curve(t / period - std::floor(t / period));
    recorder.add(static_cast<std::int64_t>(std::llround(1e9 * t)), &value);
  }
}

TEST(TurnLoads, AChannelWithoutAValueHasNone) {
  TurnLoadsRecorder recorder(2);
  const double half[] = {1.0, kNaN};
  recorder.add(1, half);
  recorder.add(2, half);
  const TurnLoads turn = recorder.endTurn(3);
  EXPECT_EQ(turn.channels[0].mean, 1.0);
  const auto& [minimum, maximum, mean] = turn.channels[1];
  EXPECT_TRUE(std::isnan(mean) && std::isnan(minimum.value) && std::isnan(maximum.value));
  EXPECT_TRUE(std::isnan(recorder.endTurn(4).channels[0].mean));  // the previous revolution leaves no value
}

TEST(TurnLoads, ARestartForgetsTheTurnBegun) {
  TurnLoadsRecorder recorder(1);
  const double large = 1e9, small = 1.0;
  recorder.add(1, &large);
  recorder.endTurn(2);
  recorder.add(3, &large);
  recorder.restart();
  recorder.add(0, &small);
  const TurnLoads& turn = recorder.endTurn(5);
  EXPECT_FALSE(turn.whole);
  EXPECT_EQ(turn.channels[0].maximum.value, 1.0);
  EXPECT_EQ(turn.start, 0);
}

TEST(TurnExtremes, ASampleThatIsHardlyKnownMayBeTheExtreme) {
  TurnExtremes known, hardly;
  for (TurnExtremes* turn : {&known, &hardly}) {
    turn->add(10.0, {1.0, 0.1});
    turn->add(0.0, {2.0, 0.2});
  }
  known.add(4.0, {3.0, 9.0});    // 1 to 7: within the extremes
  hardly.add(4.0, {12.0, 9.0});  // -8 to 16
  EXPECT_EQ(known.range(), 10.0);
  EXPECT_EQ(hardly.range(), 10.0);
  EXPECT_DOUBLE_EQ(known.ofRange().own, std::hypot(1.0, 2.0));
  EXPECT_DOUBLE_EQ(hardly.ofRange().own, std::hypot(6.0, 8.0));
  EXPECT_DOUBLE_EQ(hardly.ofRange().common, 0.3);
}

TEST(TurnExtremes, HaveNoDeviationWithoutThoseOfSamples) {
  TurnExtremes turn;
  turn.add(1.0, {});
  turn.add(3.0, {});
  EXPECT_EQ(turn.range(), 2.0);
  EXPECT_TRUE(std::isnan(turn.ofRange().own));
}

}  // namespace
}  // namespace hammer_loads::life
