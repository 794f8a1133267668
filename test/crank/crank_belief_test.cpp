// Bounds of the crank's belief.
#include "hammer_loads/crank/crank_belief.h"

#include <gtest/gtest.h>

namespace hammer_loads {
namespace {

/// A crank at 25 rad/s, 0.3 rad after the blow.
CrankBelief turning() {
  CrankBelief belief;
  belief.state = {{0, {0.3, Side::kAfterBlow}}, 25.0, 100.0, 0.6};
  belief.least_inertia = 1e-6, belief.most_inertia = 1e6;
  belief.covariance.diagonal() << 1e-6, 0.04, 100.0, 1e-4, 1e-4;
  return belief;
}

/// What the bound takes off the factor it gives to the speed that goes with it.
TEST(BeliefBounds, ABoundFactorTakesTheSpeedAlong) {
  CrankBelief belief = turning();
  constexpr double kBefore = 13.0;
  belief.factor = -0.3, belief.state.speed = kBefore * belief.factor;
  belief.addNoise(CrankBelief::kSpeed, CrankBelief::kFactor, kBefore * 1e-4);
  belief.boundFactor();
  EXPECT_NEAR(belief.state.speed, kBefore * belief.factor, 1e-9);
}

}  // namespace
}  // namespace hammer_loads
