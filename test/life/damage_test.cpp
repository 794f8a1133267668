// Results compared with printed values, hand calculation and finite differences.
#include "hammer_loads/life/damage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/util/constants.h"
#include "life/astm_reference.h"

namespace hammer_loads::life {
namespace {

using namespace test;

const std::vector<RangeMean> kFigure6{{3, -0.5, 0.5}, {4, -1, 0.5}, {4, 1, 1},    {6, 1, 0.5},
                                      {8, 0, 0.5},    {8, 1, 0.5},  {9, 0.5, 0.5}};

const RangeDeviation kNone{kNaN, 0.0, kNaN};

TEST(EquivalentLoad, EqualsO1OfTheStandardsExample) {
  // nine digits quoted
  EXPECT_NEAR(equivalentLoad(kFigure6, 3.0, 1.0, kNone).value, 10.3039982, 5e-8);
  EXPECT_NEAR(equivalentLoad(kFigure6, 4.0, 1.0, kNone).value, 9.58741061, 5e-9);
  EXPECT_NEAR(equivalentLoad(kFigure6, 5.0, 1.0, kNone).value, 9.25325663, 5e-9);
  EXPECT_NEAR(equivalentLoad(kFigure6, 10.0, 1.0, kNone).value, 8.82000396, 5e-9);
}

// O11: with one equivalent cycle per T_eq, a sine of amplitude A and frequency f over T has 2 A (f T_eq)^(1/m) for any
// mean. Samples lie at the peaks; the half cycles from and to the mean at both ends are the rest.
TEST(EquivalentLoad, EqualsO11ForASine) {
  const double amplitude = 7.0, frequency = 5.0, equivalent_period = 2.0;
  const int periods = 100000;
  for (const double mean : {0.0, -31.0}) {
    Series sine{mean};
    for (int i = 0; i < periods; ++i) sine.insert(sine.end(), {mean + amplitude, mean - amplitude});
    sine.push_back(mean);
    const std::vector<RangeMean> cycles = rangesAndMeans(exactCount(sine));
    for (const double slope : {3.0, 4.0, 5.0, 10.0}) {
      const double equivalents = periods / frequency / equivalent_period;
      const double expected = 2.0 * amplitude * std::pow(frequency * equivalent_period, 1.0 / slope);
      EXPECT_NEAR(equivalentLoad(cycles, slope, equivalents, kNone).value, expected, expected / periods);
    }
  }
}

// O11: damage sums of joined records are additive.
TEST(EquivalentLoad, AddsUpOverRecordsAsInO11) {
  std::vector<RangeMean> both = kFigure6;
  both.insert(both.end(), {{2.5, 0.0, 17.0}, {11.0, 3.0, 0.5}});
  const double first = std::pow(equivalentLoad(kFigure6, 5.0, 1.0, kNone).value, 5.0);
  const double second = 17.0 * std::pow(2.5, 5.0) + 0.5 * std::pow(11.0, 5.0);
  EXPECT_NEAR(std::pow(equivalentLoad(both, 5.0, 1.0, kNone).value, 5.0), first + second, 1e-13 * (first + second));
}

TEST(EquivalentLoad, HasAValueForNoCyclesAndForExtremeOnes) {
  EXPECT_EQ(equivalentLoad({}, 5.0, 10.0, {1.0, 0.0, kNaN}).value, 0.0);
  EXPECT_EQ(equivalentLoad({}, 5.0, 10.0, {1.0, 0.0, kNaN}).deviation, 0.0);
  EXPECT_NEAR(equivalentLoad({{1e200, 0.0, 1.0}}, 10.0, 1.0, kNone).value / 1e200, 1.0, 1e-14);
  EXPECT_NEAR(equivalentLoad({{1e-200, 0.0, 1.0}}, 10.0, 1.0, kNone).value / 1e-200, 1.0, 1e-14);
}

Series twoSines() {
  const int n = 200000;
  Series series(n);
  for (int i = 0; i < n; ++i) {
    const double t = i / (n - 1.0);
    series[static_cast<std::size_t>(i)] = 1000.0 * (std::sin(2000.0 * kPi * t) + std::sin(1000.0 * kPi * t));
  }
  return series;
}

// O12: amplitude 1000 at 1e7 cycles, slope 5.
TEST(Damage, EqualsO12ForTwoSines) {
  const SnCurve curve = SnCurve::make(2000.0, 1e7, 5.0, 5.0).value.value();
  const double by_hand = 8.451272e-4;
  const ExactCycles count = exactCount(twoSines());
  EXPECT_NEAR(damage(rangesAndMeans(count), curve, {}, kNone).value, 8.44221e-4, 5e-10);
  Series twice = twoSines();  // the record repeated, minus the record once: the repeated residue
  for (const double value : twoSines()) twice.push_back(value);
  const double repeated = damage(rangesAndMeans(exactCount(twice)), curve, {}, kNone).value - 8.44221e-4;
  EXPECT_NEAR(repeated, 8.45013e-4, 1e-9);
  double closed = 0.0;
  for (const auto& [pair, n] : count.closed())
    closed += static_cast<double>(n) * curve.damage(pair.second - pair.first);
  EXPECT_NEAR(closed, 4.159e-4, 5e-8);
  // On a grid each range has an error below one width. The 500 largest cycles cause nearly all damage.
  for (const int classes : {64, 1024, 4096, 16384}) {
    const LoadGrid grid = LoadGrid::make(-2000.0, 2000.0, classes).value.value();
    const CycleCount on_grid = gridCount(twoSines(), grid);
    EXPECT_LE(on_grid.residue.size(), 2U * static_cast<unsigned>(classes) - 1U);
    const double value = damage(rangesAndMeans(on_grid), curve, {}, kNone).value;
    const double bound = std::pow(1.0 + grid.width() / 3520.0, 5.0) - 1.0 + 1.1e-3;  // grid and sampling
    EXPECT_NEAR(value / by_hand, 1.0, bound) << classes;
    std::printf("O12 on %d classes: %+.3f %% of the damage, residue %zu\n", classes, 100.0 * (value / by_hand - 1.0),
                on_grid.residue.size());
  }
}

TEST(Damage, EqualsO13ForMeanStressByFkm) {
  const FkmMeanStress fkm{0.3};
  const struct {
    double amplitude, mean, at_alternating;
  } kRows[] = {{2, 2, 2.6},      {3, 3, 3.9}, {3, 2, 3.6},  {2, 4, 2.836363}, {2, 3, 2.718181},
               {1, 3, 1.536363}, {2, 1, 2.3}, {2, -2, 1.4}, {2, -9, 1.4}};
  for (const auto& row : kRows)
    EXPECT_NEAR(fkm.atAlternating(row.amplitude, row.mean).amplitude, row.at_alternating, 1e-6);
  EXPECT_EQ(fkm.atAlternating(0.0, 0.0).amplitude, 0.0);
  EXPECT_EQ(fkm.atAlternating(0.0, 5.0).amplitude, 0.0);
  for (double mean = -5.0; mean < 8.0; mean += 0.0371) {  // continuous, and the derivative agrees
    const double h = 1e-7, at = fkm.atAlternating(2.0, mean).amplitude;
    EXPECT_NEAR(fkm.atAlternating(2.0, mean + h).amplitude, at, 1e-6);
    const double derivative = (fkm.atAlternating(2.0 + h, mean).amplitude - at) / h;
    EXPECT_NEAR(fkm.atAlternating(2.0, mean).derivative, derivative, 1e-6);
  }
}

TEST(Damage, TwoSlopesMeetAtTheKnee) {
  const SnCurve curve = SnCurve::make(52.6, 1e7, 3.0, 5.0).value.value();
  EXPECT_NEAR(curve.damage(52.6), 1e-7, 1e-22);
  EXPECT_NEAR(curve.damage(2.0 * 52.6), 8e-7, 1e-20);
  EXPECT_NEAR(curve.damage(0.5 * 52.6), 1e-7 / 32.0, 1e-22);
  const Figure one = damage({{105.2, 0.0, 1000.0}, {26.3, 500.0, 32.0}}, curve, {}, kNone);
  EXPECT_NEAR(one.value, 8e-4 + 1e-7, 1e-17);
  EXPECT_TRUE(std::isnan(one.deviation));
  EXPECT_FALSE(SnCurve::make(0.0, 1e7, 3.0, 5.0).value);
  EXPECT_FALSE(SnCurve::make(52.6, 1e7, 5.0, 3.0).value);
  EXPECT_EQ(SnCurve::make(kNaN, -1.0, 0.0, -1.0).problems.size(), 4U);
}

TEST(Damage, DeviationIsTheDerivativeWithRespectToAllRangesAsThatOfTheEquivalentLoad) {
  const SnCurve curve = SnCurve::make(5.0, 1e7, 3.0, 5.0).value.value();
  const double h = 1e-6, deviation = 0.2;
  const std::vector<RangeMean> cycles{{3, -20, 4}, {4, 0, 7}, {6, 7, 2}, {8, 1, 1}, {9, 40, 3}};
  const auto expectDerivative = [&](const auto& figureOf) {
    std::vector<RangeMean> more = cycles, less = cycles;
    for (RangeMean& c : more) c.range += h;
    for (RangeMean& c : less) c.range -= h;
    const double derivative = (figureOf(more, kNone).value - figureOf(less, kNone).value) / (2.0 * h);
    EXPECT_NEAR(figureOf(cycles, {deviation, 0.0, kNaN}).deviation / (deviation * derivative), 1.0, 1e-8);
  };
  using Cycles = std::vector<RangeMean>;
  for (const auto& mean : {std::optional<FkmMeanStress>{}, std::optional(FkmMeanStress{0.3})})
    expectDerivative([&](const Cycles& c, const RangeDeviation& of) { return damage(c, curve, mean, of); });
  for (const double slope : {3.0, 10.0})
    expectDerivative([&](const Cycles& c, const RangeDeviation& of) { return equivalentLoad(c, slope, 3.0, of); });
}

TEST(Damage, APartOfAllRangesIsTheSamePartOfTheEquivalentAndSlopesTimesThatOfTheDamage) {
  const RangeDeviation parts{0.0, 0.03, 0.04};
  const Figure load = equivalentLoad(kFigure6, 5.0, 3.0, parts);
  EXPECT_NEAR(load.common / load.value, 0.04, 1e-15);
  EXPECT_NEAR(load.deviation / load.value, 0.05, 1e-15);
  const Figure taken = damage(kFigure6, SnCurve::make(5.0, 1e7, 4.0, 4.0).value.value(), {}, parts);
  EXPECT_NEAR(taken.common / taken.value, 4.0 * 0.04, 1e-14);
  EXPECT_NEAR(remainingHours(taken, 2.0).common / (2.0 / taken.value), 4.0 * 0.04, 1e-14);
}

TEST(Damage, RemainingHoursFollowTheRateSoFar) {
  EXPECT_NEAR(remainingHours({0.25, 0.05}, 100.0).value, 300.0, 1e-12);
  EXPECT_NEAR(remainingHours({0.25, 0.05}, 100.0).deviation, 80.0, 1e-12);  // of hours/damage: 20 % of 400 h
  EXPECT_EQ(remainingHours({1.5, 0.0}, 100.0).value, 0.0);
  EXPECT_TRUE(std::isinf(remainingHours({0.0, 0.0}, 100.0).value));
}

}  // namespace
}  // namespace hammer_loads::life
