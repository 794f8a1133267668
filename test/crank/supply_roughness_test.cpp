// What sequences of innovations make of the torque's walk.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hammer_loads/crank/supply.h"

namespace hammer_loads {
namespace {

/// After ten thousand innovations, each `memory` times the one before and noise, of variance 4.
double factorAfter(double memory, double jitter) {
  SupplyRoughness supply;
  std::mt19937 random(3);
  std::normal_distribution<> normal;
  double innovation = 0.0;
  for (int i = 0; i < 10000; ++i) {
    innovation = memory * innovation + 2.0 * std::sqrt(1.0 - memory * memory) * normal(random);
    supply.learn(innovation, 4.0, jitter);
  }
  return supply.factor();
}

TEST(SupplyRoughness, IsRougherWhereInnovationsKeepTheirSign) {
  EXPECT_GT(factorAfter(0.3, 0.8), 2.0);
  EXPECT_LT(factorAfter(-0.3, 0.8), 0.5);
}

TEST(SupplyRoughness, IsTheGivenOneWhileStampsAreExact) {
  EXPECT_EQ(factorAfter(0.3, 0.0), 1.0);
  EXPECT_EQ(factorAfter(-0.3, 0.0), 1.0);
}

}  // namespace
}  // namespace hammer_loads
