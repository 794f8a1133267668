// Tests that a boom's vibration beyond the largest effect of its loads is detected, and that the strongest excitation
// within them is not.
#include "hammer_loads/pipeline/vibration_bound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/bench/boom_errors.h"

namespace hammer_loads {
namespace {

struct ShakenBoom {
  Settings settings = accuracy::shippedBoom("{}");
  Boom boom = *settings.boom;
  VibrationBound bound;
  ShakenBoom() {
    JointMotion motion;
    motion.position = motion.velocity = motion.acceleration = JointVector::Zero(boom.chain().joints());
    motion.position[1] = -0.45, motion.position[2] = 1.0, motion.position[3] = -0.5;
    boom.moveCompliant(motion, {0.0, 0.0, -9.80665});
  }
  JointVector torqueOf(double force_z) const { return boom.hammerTorque({{0.0, 0.0, force_z}, {0.0, 0.0, 0.0}}); }
};

/// Resonance with the lowest mode is the worst effect of a force of given size: 40 kN for 10 s.
TEST(VibrationBound, HoldsForAnyForceAtResonance) {
  ShakenBoom shaken;
  ASSERT_TRUE(shaken.boom.vibration().known());
  const double omega = shaken.boom.vibration().mode(0).omega, h = 1e-3;
  double most = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const auto at = [&](double t) { return shaken.torqueOf(4e4 * std::sin(omega * t)); };
    const JointVector from = at(i * h), to = at((i + 1) * h);
    const TorqueStep step{from, to, 0.5 * (from + to)};
    shaken.boom.vibration().advance(h, step);
    shaken.bound.advance(shaken.boom.vibration(), h, step);
    ASSERT_TRUE(shaken.bound.holds(shaken.boom.vibration())) << i;
    most = std::max(most, shaken.boom.vibration().energy());
  }
  EXPECT_GT(most, 1000.0) << "it does shake";
}

/// A motion that no load has caused violates the bound.
TEST(VibrationBound, DoesNotHoldForEnergyFromNowhere) {
  ShakenBoom shaken;
  EXPECT_TRUE(shaken.bound.holds(shaken.boom.vibration()));
  const JointVector impulse = shaken.torqueOf(2000.0);  // [N s] on the hull: a blow has some 200
  shaken.boom.vibration().strike(impulse);
  shaken.bound.strike(shaken.boom.vibration(), impulse);
  EXPECT_TRUE(shaken.bound.holds(shaken.boom.vibration())) << "it was struck";
  shaken.boom.vibration().strike(1e4 * impulse);
  EXPECT_FALSE(shaken.bound.holds(shaken.boom.vibration()));
  shaken.boom.vibration().reset();
  EXPECT_TRUE(shaken.bound.holds(shaken.boom.vibration()));
}

}  // namespace
}  // namespace hammer_loads
