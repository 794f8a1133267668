// The counter on its grid: full scale, skipped values, memory.
#include "hammer_loads/life/cycle_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/util/constants.h"
#include "life/astm_reference.h"
#include "support/counting_new.h"
#include "support/resident_memory.h"

namespace hammer_loads::life {
namespace {

using namespace test;

TEST(LoadGrid, RefusesWhatIsNoScale) {
  EXPECT_FALSE(LoadGrid::make(0.0, 0.0, 10).value);
  EXPECT_FALSE(LoadGrid::make(1.0, 0.0, 10).value);
  EXPECT_FALSE(LoadGrid::make(kNaN, 1.0, 10).value);
  EXPECT_FALSE(LoadGrid::make(0.0, kInfinity, 10).value);
  EXPECT_FALSE(LoadGrid::make(-1.7e308, 1.7e308, 10).value);
  EXPECT_FALSE(LoadGrid::make(1e16, 1e16 + 4, 4096).value);
  EXPECT_FALSE(LoadGrid::make(0.0, 1e-310, 4096).value);
  EXPECT_FALSE(LoadGrid::make(0.0, 1.0, 1).value);
  EXPECT_FALSE(LoadGrid::make(0.0, 1.0, LoadGrid::kMostClasses + 1).value);
  EXPECT_EQ(LoadGrid::make(0.0, -1.0, 0).problems.size(), 2U);
  EXPECT_TRUE(LoadGrid::make(0.0, 1.0, LoadGrid::kMostClasses).value);
}

TEST(LoadGrid, EveryValueOfTheScaleIsWithinHalfAClassOfItsCentre) {
  const LoadGrid grid = LoadGrid::make(-173.0, 911.0, 4096).value.value();
  for (int i = 0; i <= 100000; ++i) {
    const double value = -173.0 + 1084.0 * i / 100000.0;
    ASSERT_LE(std::abs(grid.level(grid.classOf(value)) - value), 0.5 * grid.width() * (1.0 + 1e-9)) << value;
  }
  EXPECT_EQ(grid.classOf(911.0), 4095U);
  EXPECT_EQ(grid.classOf(-173.0), 0U);
}

TEST(CycleCounter, SaturationIsCountedAndCountsInTheOuterClass) {
  const LoadGrid grid = LoadGrid::make(-10.0, 10.0, 20).value.value();
  const CycleCount count = gridCount({0.0, 10.0, 10.1, -1e299, 3.0, 1e30, -10.0}, grid);
  EXPECT_EQ(count.tally.counted, 7U);
  EXPECT_EQ(count.tally.above, 2U);
  EXPECT_EQ(count.tally.below, 1U);
  EXPECT_EQ(count.residue, (std::vector<std::uint32_t>{10, 19, 0}));
  EXPECT_EQ(count.closed, (std::vector<ClosedCycles>{{19, 0, 1}}));
  EXPECT_EQ(count.extremes.least, -1e299);
  EXPECT_EQ(count.extremes.greatest, 1e30);
}

TEST(CycleCounter, ANumberThatIsNoneChangesItsOwnCountAlone) {
  const LoadGrid grid = integerGrid(-5, 5);
  const Series good{1, -3, 5, -1, 3, -4, 4, -2};
  Series with;
  for (const double value : good) with.insert(with.end(), {kNaN, value, kInfinity, -kInfinity, 2e300});
  const CycleCount clean = gridCount(good, grid);
  CycleCount dirty = gridCount(with, grid);
  EXPECT_EQ(dirty.tally.skipped, 4 * good.size());
  dirty.tally.skipped = 0;
  EXPECT_EQ(textOf(dirty), textOf(clean));
  EXPECT_EQ(exactCount(with).tally().skipped, 4 * good.size());
  EXPECT_EQ(exactCount(with).residue(), exactCount(good).residue());
}

TEST(CycleCounter, TakesNoMemoryAfterItsStart) {
  CycleCounter counter(LoadGrid::make(-1.0, 1.0, 4096).value.value());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(-1.1, 1.1);
  Series noise(100000);
  for (double& v : noise) v = value(random);
  Series spiral;  // the longest possible residue
  for (int i = 1; i < 4096; ++i) spiral.push_back((i % 2 == 0 ? 1 : -1) * (i / 4096.0));
  for (int i = 4095; i > 0; --i) spiral.push_back((i % 2 == 0 ? -1 : 1) * (i / 4096.0));
  const std::size_t before = ::hammer_loads::test::allocations;
  for (const double v : noise) counter.add(v);
  for (const double v : spiral) counter.add(v);
  EXPECT_EQ(::hammer_loads::test::allocations, before);
}

// A node counts many kinds of cycles over months. Its memory is that of one period.
TEST(CycleCounter, GivesBackItsMemoryWithEachPiece) {
  CycleCounter counter(LoadGrid::make(-1.0, 1.0, 4096).value.value());
  std::mt19937 random(8);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  double before = 0.0;
  for (int piece = 0; piece < 300; ++piece) {
    for (int i = 0; i < 300; ++i) counter.add(value(random));
    counter.take();
    if (piece == 0) before = ::hammer_loads::test::residentMemory();
  }
  EXPECT_LT(::hammer_loads::test::residentMemory() - before, 2e6);
}

// Counts as many cycles of one kind as a cell holds, slightly more and several times as many.
TEST(CycleCounter, ManyCyclesOfOneKindAreCounted) {
  for (const std::uint64_t cycles : {65535ULL, 65536ULL, 65537ULL, 200000ULL}) {
    CycleCounter counter(integerGrid(0, 9));
    std::uint64_t counted = 0;
    for (int piece = 0; piece < 2; ++piece) {
      for (std::uint64_t i = 0; i < cycles; ++i) {
        counter.add(2.0);
        counter.add(9.0);
        counter.add(4.0);
        counter.add(7.0);
      }
      for (const ClosedCycles& c : counter.take().closed) {
        if (c.steps == 3) {
          counted += c.count;
        }
      }
    }
    EXPECT_EQ(counted, 2 * cycles - 1);  // the last one is in the residue
  }
}

}  // namespace
}  // namespace hammer_loads::life
