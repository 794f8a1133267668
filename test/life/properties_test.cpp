// Properties of every series: agreement with ASTM's own procedure, additive pieces, largest range, sign reversal.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "life/astm_reference.h"

namespace hammer_loads::life {
namespace {

using namespace test;

TEST(Properties, EqualsAstmsProcedure) {
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    const Series series = randomIntegers(random, random() % 60, -8, static_cast<int>(random() % 12));
    const Cycles reference = astmCount(series);
    ASSERT_EQ(cyclesOf(rangesAndMeans(exactCount(series))), reference) << i;
    ASSERT_EQ(cyclesOf(rangesAndMeans(gridCount(series, integerGrid(-8, 12)))), reference) << i;
  }
}

/// Cuts a series into pieces of one to several values, with empty pieces in between.
std::vector<Series> cut(const Series& series, std::mt19937& random) {
  std::vector<Series> pieces(1);
  const auto every = 2 + random() % 40;
  for (const double value : series) {
    while (random() % every == 0) pieces.emplace_back();
    pieces.back().push_back(value);
  }
  return pieces;
}

TEST(Properties, CuttingsAddToTheWholeExactly) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Series series = randomIntegers(random, random() % 300, 0, 1 + static_cast<int>(random() % 40));
    const LoadGrid grid = integerGrid(0, 40);
    const CycleCount whole = gridCount(series, grid);
    const std::vector<Series> pieces = cut(series, random);
    CycleCount sum(grid);
    CycleCounter live(grid);
    CycleCount taken(grid);
    for (const Series& piece : pieces) {
      append(gridCount(piece, grid), sum);
      for (const double value : piece) live.add(value);
      taken.advance(live.take());
    }
    ASSERT_EQ(textOf(sum), textOf(whole));
    ASSERT_EQ(textOf(taken), textOf(whole));
  }
}

// ((a + b) + c) equals (a + (b + c)): pieces may be added in groups.
TEST(Properties, AddingIsAssociative) {
  std::mt19937 random(3);
  const LoadGrid grid = integerGrid(0, 30);
  for (int i = 0; i < 2000; ++i) {
    const CycleCount a = gridCount(randomIntegers(random, random() % 50, 0, 30), grid);
    const CycleCount b = gridCount(randomIntegers(random, random() % 50, 0, 30), grid);
    const CycleCount c = gridCount(randomIntegers(random, random() % 50, 0, 30), grid);
    CycleCount left = a, right = b, whole = a;
    append(b, left);
    append(c, left);
    append(c, right);
    append(right, whole);
    ASSERT_EQ(textOf(left), textOf(whole));
  }
}

TEST(Properties, LargestRangeIsMaximumLessMinimumAndASignFlipMirrors) {
  std::mt19937 random(4);
  std::normal_distribution<double> value(3.0, 10.0);
  for (int i = 0; i < 2000; ++i) {
    Series series(2 + random() % 200);
    std::generate(series.begin(), series.end(), [&] { return value(random); });
    const auto [least, greatest] = std::minmax_element(series.begin(), series.end());
    const std::vector<RangeMean> cycles = rangesAndMeans(exactCount(series));
    ASSERT_EQ(cycles.back().range, *greatest - *least);
    Series flipped = series;
    for (double& v : flipped) v = -v;
    Cycles mirrored;
    for (const RangeMean& c : rangesAndMeans(exactCount(flipped))) mirrored[{c.range, -c.mean}] += c.count;
    ASSERT_EQ(mirrored, cyclesOf(cycles));
  }
}

// With n classes, ranges of 1, 2 .. n - 1, n - 1 .. 2, 1 steps never close. They have 2n - 1 points, one more than
// often quoted (2n - 2 without the running end).
TEST(Properties, ResidueOnAGridHasAtMostTwiceTheClassesLessOnePoints) {
  for (std::uint32_t n = 2; n <= 5; ++n) {
    std::set<std::vector<std::uint32_t>> reached{{}};  // every residue that a series can give
    std::vector<std::vector<std::uint32_t>> open{{}};
    std::size_t longest = 0;
    while (!open.empty()) {
      const std::vector<std::uint32_t> residue = std::move(open.back());
      open.pop_back();
      longest = std::max(longest, residue.size());
      for (std::uint32_t next = 0; next < n; ++next) {
        FourPointStack<std::uint32_t> stack;
        for (const std::uint32_t point : residue) stack.push(point, [](std::uint32_t, std::uint32_t) {});
        stack.push(next, [](std::uint32_t, std::uint32_t) {});
        if (reached.insert(stack.residue()).second) open.push_back(stack.residue());
      }
    }
    EXPECT_EQ(longest, 2 * n - 1);
  }
  const int n = 4096;
  Series spiral;
  double at = n / 2 - 1.0;
  spiral.push_back(at);
  for (int step = 1; step < n; ++step) spiral.push_back(at += step % 2 == 1 ? step : -step);
  Series whole = spiral;
  for (int step = n - 1; step > 0; --step) whole.push_back(at += step % 2 == 1 ? -step : step);
  const CycleCount count = gridCount(whole, integerGrid(0, n - 1));
  EXPECT_EQ(count.residue.size(), static_cast<std::size_t>(2 * n - 1));
  EXPECT_TRUE(count.closed.empty());
}

}  // namespace
}  // namespace hammer_loads::life
