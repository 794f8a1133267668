// Channels and hot spots of a machine, counted in pieces.
#include "hammer_loads/life/life_recorder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/util/constants.h"
#include "life/astm_reference.h"

namespace hammer_loads::life {
namespace {

using namespace test;
constexpr std::int64_t kSecond = 1000000000;

const std::vector<std::string> kInputs{"hull_wrench/force_x", "hull_wrench/force_z", "section_loads/foot/torque_y"};

LifeSettings settings() {
  const LoadGrid force = LoadGrid::make(-1000.0, 1000.0, 400).value.value();
  const LoadGrid stress = LoadGrid::make(-50.0, 50.0, 500).value.value();
  LifeSettings s;
  s.channels = {{kInputs[1], force}, {"stress/toe", stress, "toe", {{kInputs[2], 0.02}, {kInputs[1], -0.01}}}};
  s.period = 60 * kSecond;
  s.equivalent_cycles_per_hour = 3600.0;
  return s;
}

TEST(LifeRecorder, AHotSpotIsTheSumOfItsLoadsAtEachInstant) {
  LifeRecorder recorder(settings(), kInputs);
  EXPECT_EQ(recorder.channels(), (std::vector<std::string>{"hull_wrench/force_z", "stress/toe"}));
  std::mt19937 random(1);
  std::normal_distribution<double> load(0.0, 300.0);
  Series force, stress;
  for (int i = 0; i < 5000; ++i) {
    const double values[] = {load(random), load(random), load(random)};
    recorder.sample(i, values, nullptr);
    force.push_back(values[1]);
    stress.push_back(0.02 * values[2] - 0.01 * values[1]);
  }
  const LifePiece piece = recorder.take();
  EXPECT_EQ(textOf(piece.counts[0]), textOf(gridCount(force, recorder.grid(0))));
  EXPECT_EQ(piece.counts[1].closed, gridCount(stress, recorder.grid(1)).closed);
}

TEST(LifeRecorder, AMissingLoadLeavesItsChannelsOut) {
  LifeRecorder recorder(settings(), kInputs);
  const double whole[] = {1.0, 2.0, 3.0}, part[] = {1.0, 2.0, kNaN};
  recorder.sample(1, whole, nullptr);
  recorder.sample(2, part, nullptr);
  const LifePiece piece = recorder.take();
  EXPECT_EQ(piece.counts[0].tally.counted, 2U);
  EXPECT_EQ(piece.counts[1].tally.counted, 1U);
  EXPECT_EQ(piece.counts[1].tally.skipped, 1U);
}

TEST(LifeRecorder, DeviationsAddInSquaresOverAHotSpotsLoads) {
  LifeRecorder recorder(settings(), kInputs);
  const double values[] = {1.0, 2.0, 3.0}, first[] = {9.0, 40.0, 100.0}, second[] = {9.0, 80.0, 200.0};
  recorder.sample(1, values, first);
  recorder.sample(2, values, second);
  const LifePiece piece = recorder.take();
  const double force_unit = recorder.grid(0).width() / kDeviationUnits;
  EXPECT_NEAR(meanDeviation(piece.counts[0]), 60.0, force_unit);
  EXPECT_NEAR(meanDeviation(piece.counts[1]), 1.5 * std::hypot(2.0, 0.4), recorder.grid(1).width() / kDeviationUnits);
  EXPECT_TRUE(std::isnan(meanDeviation(CycleCount(recorder.grid(0)))));
}

TEST(LifeRecorder, RangesOfTurnsCarryTheErrorsOfTheirTwoEnds) {
  LifeRecorder recorder(settings(), kInputs);
  const auto sample = [&](std::int64_t stamp, double force, double deviation, double common) {
    const double values[] = {0.0, force, 0.0}, deviations[] = {0.0, deviation, 0.0}, alike[] = {0.0, common, 0.0};
    recorder.sample(stamp, values, deviations, alike);
  };
  EXPECT_TRUE(std::isnan(rangeDeviation(CycleCount(recorder.grid(0))).common));
  sample(1, -100.0, 5.0, 3.0);   // own 4
  sample(2, 0.0, 100.0, 100.0);  // not an end of the range
  sample(3, 300.0, 13.0, 12.0);  // own 5
  recorder.turn();
  const RangeDeviation one = rangeDeviation(recorder.take().counts[0]);
  EXPECT_NEAR(one.own, std::hypot(4.0, 5.0) / 400.0, 1e-4);
  EXPECT_NEAR(one.common, 15.0 / 400.0, 1e-4);
  EXPECT_EQ(one.absolute, 0.0);
  CycleCount sum(recorder.grid(0));
  for (int turn = 0; turn < 50; ++turn) {
    sample(4 + 2 * turn, -100.0, 5.0, 3.0), sample(5 + 2 * turn, 300.0, 13.0, 12.0);
    recorder.turn();
    append(recorder.take().counts[0], sum);
  }
  EXPECT_NEAR(rangeDeviation(sum).common, 15.0 / 400.0, 1e-4) << "does not average out";
}

TEST(LifeRecorder, RefusesUnknownChannels) {
  LifeSettings s = settings();
  s.channels[1].influences.push_back({"no/such_N", 1.0});
  EXPECT_THROW(LifeRecorder(s, kInputs), std::invalid_argument);
}

TEST(LifeRecorder, PiecesEndAtPeriodsAtMidnightAndWhereTimeRunsBack) {
  LifeRecorder recorder(settings(), kInputs);
  const double values[] = {1.0, 2.0, 3.0};
  const std::int64_t day = 86400 * kSecond, start = 20000 * day + 3600 * kSecond;
  EXPECT_FALSE(recorder.due(start));
  recorder.sample(start, values, nullptr);
  EXPECT_FALSE(recorder.due(start + 60 * kSecond - 1));
  EXPECT_TRUE(recorder.due(start + 60 * kSecond));
  EXPECT_TRUE(recorder.due(start - 1));
  recorder.take();
  EXPECT_FALSE(recorder.due(start + 600 * kSecond));
  recorder.sample(20001 * day - kSecond, values, nullptr);
  EXPECT_FALSE(recorder.due(20001 * day - 1));
  EXPECT_TRUE(recorder.due(20001 * day));
  EXPECT_EQ(dayOf(20001 * day), 20001);
  EXPECT_EQ(dayOf(20001 * day - 1), 20000);
  EXPECT_EQ(dayOf(-1), -1);
  EXPECT_EQ(dayOf(-day), -1);
}

TEST(LifeRecorder, TimeIsThatBetweenSamplesWithoutGaps) {
  LifeRecorder recorder(settings(), kInputs);
  const double values[] = {1.0, 2.0, 3.0};
  std::uint64_t duration = 0;
  const auto take = [&] { duration += recorder.take().duration; };
  recorder.sample(10 * kSecond, values, nullptr);
  recorder.sample(11 * kSecond, values, nullptr);
  take();
  recorder.sample(13 * kSecond, values, nullptr);  // across the end of the piece
  take();
  recorder.gap();
  recorder.sample(23 * kSecond, values, nullptr);
  recorder.sample(24 * kSecond, values, nullptr);
  recorder.sample(20 * kSecond, values, nullptr);  // time runs back
  recorder.sample(22 * kSecond, values, nullptr);
  take();
  EXPECT_EQ(duration, 6U * kSecond);
}

}  // namespace
}  // namespace hammer_loads::life
