// Counts printed in ASTM E1049-85 and counts by hand, compared with the exact counter and the one on a grid.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "life/astm_reference.h"

namespace hammer_loads::life {
namespace {

using namespace test;

const Series kSeriesOfFigure6{-2, 1, -3, 5, -1, 3, -4, 4, -2};

void expectRanges(const Series& series, const Ranges& expected) {
  EXPECT_EQ(rangesOf(cyclesOf(rangesAndMeans(exactCount(series)))), expected);
  Series doubled;
  for (const double value : series) doubled.insert(doubled.end(), {value, value});
  EXPECT_EQ(rangesOf(cyclesOf(rangesAndMeans(exactCount(doubled)))), expected);
  const LoadGrid halves = LoadGrid::make(-20.25, 20.25, 81).value.value();  // centres at multiples of 1/2
  EXPECT_EQ(rangesOf(cyclesOf(rangesAndMeans(gridCount(series, halves)))), expected);
}

using ClosedPairs = std::vector<std::tuple<double, double, int>>;  // lower, upper extreme, count

void expectClosed(const Series& series, const ClosedPairs& closed, const Series& residue) {
  const ExactCycles count = exactCount(series);
  ExactCycles::Closed expected;
  for (const auto& [low, high, times] : closed) expected[{low, high}] += static_cast<std::uint64_t>(times);
  EXPECT_EQ(count.closed(), expected);
  EXPECT_EQ(count.residue(), residue);
  const CycleCount on_grid = gridCount(series, integerGrid(-20, 20));
  ASSERT_EQ(on_grid.closed.size(), expected.size());
  for (const ClosedCycles& c : on_grid.closed) EXPECT_EQ(expected.at({c.low - 20.0, c.low + c.steps - 20.0}), c.count);
  ASSERT_EQ(on_grid.residue.size(), residue.size());
  for (std::size_t i = 0; i < residue.size(); ++i) EXPECT_EQ(on_grid.residue[i] - 20.0, residue[i]);
}

TEST(Oracles, EqualsO1AstmFigure6) {
  expectRanges(kSeriesOfFigure6, {{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1}, {9, 0.5}});
  expectClosed(kSeriesOfFigure6, {{-1, 3, 1}}, {-2, 1, -3, 5, -4, 4, -2});
  const Cycles expected{{{3, -0.5}, 0.5}, {{4, -1}, 0.5}, {{4, 1}, 1},    {{6, 1}, 0.5},
                        {{8, 0}, 0.5},    {{8, 1}, 0.5},  {{9, 0.5}, 0.5}};
  EXPECT_EQ(cyclesOf(rangesAndMeans(exactCount(kSeriesOfFigure6))), expected);
}

// A repeating history that starts at its largest peak closes except for one cycle (ASTM E1049-85, 5.4.5).
TEST(Oracles, EqualsO2AstmFigure7) {
  const Series history{-2, 1, -3, 5, -1, 3, -4, 4};
  Series from_peak;
  for (std::size_t i = 0; i <= history.size(); ++i) from_peak.push_back(history[(3 + i) % history.size()]);
  const Ranges ranges = rangesOf(cyclesOf(rangesAndMeans(exactCount(from_peak))));
  EXPECT_EQ(ranges, (Ranges{{3, 1}, {4, 1}, {7, 1}, {9, 1}}));
  double sum = 0.0, sum_once = 0.0;
  for (const auto& [range, count] : ranges) sum += count * std::pow(range, 5);
  for (const auto& [range, count] : rangesOf(cyclesOf(rangesAndMeans(exactCount(kSeriesOfFigure6)))))
    sum_once += count * std::pow(range, 5);
  EXPECT_EQ(sum, 77123.0);
  EXPECT_NEAR(sum / sum_once - 1.0, 0.137, 5e-4);
}

}  // namespace
}  // namespace hammer_loads::life
