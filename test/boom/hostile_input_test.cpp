// Finite inputs beyond every machine: results are finite or marked, and the next sample is correct again.
#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

using test::kLevel;

/// Runs one step of a session at 1 kHz on the compliant boom.
bool sample(Boom& boom, const JointMotion& motion, const Wrench& w, BoomLoads& loads) {
  boom.moveCompliant(motion, kLevel);
  const JointVector torque = boom.hammerTorque(w);
  boom.vibration().advance(1e-3, {torque, torque, torque});
  return boom.loads(w, false, loads);
}

bool finite(const Boom& boom, const BoomLoads& loads) {
  bool all = loads.hammer.allFinite() && loads.weight.allFinite() && loads.motion.allFinite() &&
             loads.vibration.allFinite() && loads.total.allFinite();
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i)
    all = all && (loads.cylinder[i].zero_moment_arm ||
                  (std::isfinite(loads.cylinder[i].force) && std::isfinite(loads.cylinder[i].pressure)));
  return all;
}

double hostile(std::mt19937& random) {
  constexpr double kValues[] = {0.0, 1.0, -1.0, 1e-308, 5e-324, 1e15, 1e100, -1e154, 1e155, 1e200, -1e300, 1.7e308};
  return kValues[std::uniform_int_distribution<std::size_t>(0, 11)(random)];
}

TEST(HostileInput, LoadsAreFiniteOrMarkedAndRecover) {
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  const JointMotion calm{test::workingPosition(), zero, zero};
  const Wrench usual{Eigen::Vector3d(2e3, 0.0, 8e3), Eigen::Vector3d(0.0, -800.0, 0.0)};
  std::mt19937 random(41);
  int marked = 0;
  for (int i = 0; i < 20000; ++i) {
    JointMotion motion = calm;
    Wrench w = usual;
    for (int j = 0; j < 4; ++j) {
      if (random() % 4 == 0) motion.position[j] = hostile(random);
      if (random() % 4 == 0) motion.velocity[j] = hostile(random);
      if (random() % 4 == 0) motion.acceleration[j] = hostile(random);
    }
    for (int j = 0; j < 3; ++j) {
      if (random() % 4 == 0) w.force[j] = hostile(random);
      if (random() % 4 == 0) w.torque[j] = hostile(random);
    }
    BoomLoads loads;
    if (sample(boom, motion, w, loads)) {
      EXPECT_TRUE(finite(boom, loads));
    } else {
      ++marked;
      EXPECT_FALSE(finite(boom, loads));
    }
    if (i % 100 != 0) continue;
    // A usual session afterwards equals that of a boom without such a sample.
    boom.vibration().reset();
    Boom fresh = test::shippedBoom();
    for (int k = 0; k < 5; ++k) {
      BoomLoads expected;
      ASSERT_TRUE(sample(boom, calm, usual, loads));
      ASSERT_TRUE(sample(fresh, calm, usual, expected));
      ASSERT_EQ(loads.total, expected.total) << i;
    }
  }
  EXPECT_GT(marked, 1000);
  EXPECT_LT(marked, 19000);
}

TEST(HostileInput, VibrationComesToRestInsteadOfStayingInfinite) {
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  boom.moveCompliant({test::workingPosition(), zero, zero}, kLevel);
  const JointVector huge = JointVector::Constant(4, 1.7e308);
  boom.vibration().advance(1e-3, {huge, -huge, huge});
  EXPECT_TRUE(boom.vibration().torque().isZero(0.0));
  boom.moveCompliant({test::workingPosition(), zero, zero}, kLevel);
  bool rested = false;
  for (int i = 0; i < 10000; ++i) {
    boom.vibration().strike(huge);
    ASSERT_TRUE(boom.vibration().velocity().allFinite());
    rested = rested || boom.vibration().velocity().isZero(0.0);
  }
  EXPECT_TRUE(rested);
}

TEST(HostileInput, VerdictsAreOnTheSafeSide) {
  Boom boom = test::shippedBoom();
  const JointVector zero = JointVector::Zero(4);
  boom.moveCompliant({test::workingPosition(), zero, zero}, kLevel);
  const Wrench huge{Eigen::Vector3d(1e308, 0.0, 1.7e308), Eigen::Vector3d(1e308, 1e308, 1e308)};
  EXPECT_EQ(boom.rigidError(huge, 0.018), kInfinity);
  EXPECT_LT(boom.holdDown(huge).least, 1.0);
}

}  // namespace
}  // namespace hammer_loads
