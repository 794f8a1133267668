// Machines with an elastic connecting rod: a zero that a rigid-rod fit would shift is refused, with the reason.
#include "hammer_loads/calibration/rod_check.h"

#include <gtest/gtest.h>

#include <random>

#include "calibration/recorded.h"
#include "hammer_loads/calibration/report.h"

namespace hammer_loads::calibration {
namespace {

Calibration withRod(const simulation::RodSettings& rod, double zero, double rate, std::uint64_t seed) {
  simulation::MachineSettings s = test::atWork(12.0, rate);
  s.rod = rod;
  s.crank.zero = zero;
  s.seed = seed;
  const Mechanism mechanism = test::mechanismOf(s);
  return calibrate(test::recorded(s), test::basisOf(mechanism));
}

/// Damping ratio 3 is an overdamped rod. Whether the fit converges or not, nothing is written and the reason is stated,
/// so the loads stay unchanged.
TEST(RodCheck, NothingIsWrittenThatARodMovesByMoreThanAFifthOfADegree) {
  std::mt19937_64 random(77);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int settled = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const double zero = (2.0 * part(random) - 1.0) * kDegree;
    const simulation::RodSettings rod{2e8 * std::pow(50.0, static_cast<double>(i) / 3.0), i % 2 == 0 ? 3.0 : 0.4,
                                      i % 3 == 0 ? 0.0 : 5e-4 * part(random)};
    SCOPED_TRACE(testing::Message() << rod.stiffness << " N/m, " << rod.damping_ratio << ", " << rod.play << " m");
    const Calibration c = withRod(rod, zero, i % 4 == 1 ? 500.0 : 1000.0, 770 + i);
    EXPECT_NE(textOf(c, true).find("rod, pins and bearings give"), std::string::npos) << textOf(c, true);
    EXPECT_NE(textOf(c, true).find("Turn the crank by hand"), std::string::npos);
    EXPECT_NE(textOf(c).find("more such work does not help"), std::string::npos) << textOf(c);
    EXPECT_EQ(yamlOf(c, "a.bag"), "");
    if (!c.problem.empty()) continue;
    ++settled;
    EXPECT_NE(textOf(c).find("not found: crank_zero_rad"), std::string::npos) << textOf(c);
    EXPECT_NE(textOf(c).find("next: more such work does not help: turn the crank by hand"), std::string::npos);
    const Estimate* found = test::find(c, "crank_zero_rad");
    EXPECT_FALSE(found->determined()) << found->value / kDegree << " for " << zero / kDegree << " deg";
  }
  EXPECT_GT(settled, 0);
  EXPECT_LT(settled, 4);
}

TEST(RodCheck, ARigidRodIsNotSuspected) {
  for (const double zero : {1.0, -1.0}) {
    const Calibration c = withRod({}, zero * kDegree, 1000.0, 790);
    EXPECT_TRUE(test::find(c, "crank_zero_rad")->determined()) << zero;
    EXPECT_EQ(textOf(c, true).find("rod, pins"), std::string::npos) << zero;
  }
}

/// Blows of a hammer with other links have similar residuals: no fit explains them, and both causes are named.
TEST(RodCheck, AnotherHammerIsNamedBesideIt) {
  const simulation::MachineSettings s = test::atWork(12.0, 1000.0);
  HammerParameters other = s.hammer;
  other.lengths.crank *= 1.3;
  other.lengths.rod = other.lengths.pivot_distance + other.lengths.rocker - other.lengths.crank;
  const Mechanism of_other = *Mechanism::make(other).value;
  const Calibration c = calibrate(test::recorded(s), test::basisOf(of_other));
  EXPECT_NE(c.problem.find("lengths or masses of the hammer file are others"), std::string::npos) << c.problem;
}

}  // namespace
}  // namespace hammer_loads::calibration
