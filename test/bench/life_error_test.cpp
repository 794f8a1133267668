#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/estimate_errors.h"

namespace hammer_loads::accuracy {
namespace {

/// Returns the load of blows of varying strength on a slowly drifting weight.
double load(int i) { return 1e4 * std::sin(0.21 * i) * (2.0 + std::sin(0.013 * i)) + 3e3 * std::sin(0.0017 * i); }

LifeError errorOf(double factor, double offset) {
  LifeError error;
  for (int i = 0; i < 20000; ++i) error.add(factor * load(i) + offset, load(i));
  return error;
}

/// If every range is 3 % too large, the equivalent range is 3 % too large at any slope.
TEST(LifeError, IsTheFactorOfTheLoad) {
  EXPECT_NEAR(errorOf(1.03, 0.0).figure().error, 0.03, 1e-12);
  EXPECT_NEAR(errorOf(0.9, 0.0).figure().error, -0.1, 1e-12);
}

/// Weights two revolutions of ranges 20 and 60 by their range; their own deviations are hypot(1, 2) and hypot(6, 8).
TEST(LifeError, HasTheDeviationsOfTheRangesOfTurns) {
  LifeError error;
  const auto turn = [&](double top, double least_own, double top_own) {
    error.add(-10.0, -10.0, {least_own, 0.5}), error.add(top, top, {top_own, 1.5});
    error.endTurn();
  };
  turn(10.0, 1.0, 2.0), turn(50.0, 6.0, 8.0);
  const LifeFigure figure = error.figure();
  EXPECT_NEAR(figure.error, 0.0, 1e-12);
  EXPECT_NEAR(figure.own, (20.0 * std::sqrt(5.0) + 60.0 * 10.0) / (20.0 * 20.0 + 60.0 * 60.0), 1e-12);
  EXPECT_NEAR(figure.common, 2.0 * (20.0 + 60.0) / (20.0 * 20.0 + 60.0 * 60.0), 1e-12);
}

TEST(LifeError, GivesNoDeviationForLoadsWithoutOne) {
  LifeError error;
  error.add(0.0, 0.0), error.add(1.0, 1.0);
  error.endTurn();
  EXPECT_TRUE(std::isnan(error.figure().own) && std::isnan(error.figure().common));
  EXPECT_NE(json(error.figure()).find("\"own\": null"), std::string::npos);
}

/// One range r among n of size 1: (r^m + n)^(1/m) against (1 + n)^(1/m), from the definition.
TEST(LifeError, ASingleCycleCountsByItsPower) {
  constexpr int kCycles = 100;
  LifeError error;
  for (int i = 0; i < kCycles; ++i) {
    const double top = i == kCycles / 2 ? 2.0 : 1.0;
    error.add(0.0, 0.0), error.add(top, 1.0);
  }
  error.add(0.0, 0.0);
  EXPECT_NEAR(error.figure().error,
              std::pow((std::pow(2.0, kLifeSlope) + kCycles - 1) / kCycles, 1.0 / kLifeSlope) - 1.0, 1e-12);
}

}  // namespace
}  // namespace hammer_loads::accuracy
