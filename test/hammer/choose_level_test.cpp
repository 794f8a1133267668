#include "hammer_loads/hammer/choose_level.h"

#include <gtest/gtest.h>

#include <limits>

#include "hammer_loads/linkage/hammer_constants.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kG = 9.80665;

/// Returns the hammer at level linkage with the usual standard deviations of nominal parameters.
HammerParameters drawing() {
  HammerParameters p = test::mo100LinkageParameters();
  p.deviations = usualDeviations(p);
  return p;
}

TEST(ChooseLevel, AMasslessCrankAndRodNeedNoLinkage) {
  HammerParameters p = test::mo100Parameters();
  p.deviations[6] = 0.02 * p.rocker_mass;
  const LevelChoice choice = chooseLevel(test::mechanismOf(p), 1e-9, 5.0, kG);
  EXPECT_EQ(choice.level, Level::kRocker);
  EXPECT_EQ(choice.difference[1], 0.0);
  EXPECT_GT(choice.difference[0], 10.0) << "the pulse has neither Fx nor moment";
}

TEST(ChooseLevel, AnExactHammerHasNoLevelToSpare) {
  HammerParameters p = test::mo100LinkageParameters();
  p.deviations = {};
  const LevelChoice choice = chooseLevel(test::mechanismOf(p), 10.0, 5.0, kG);
  EXPECT_EQ(choice.level, Level::kLinkage);
  EXPECT_EQ(choice.difference[1], std::numeric_limits<double>::infinity());
}

TEST(ChooseLevel, TakesTheCheapestWithinTolerance) {
  const Mechanism mechanism = test::mechanismOf(drawing());
  const LevelChoice strict = chooseLevel(mechanism, 1e-6, 5.0, kG);
  EXPECT_EQ(strict.level, Level::kLinkage);
  ASSERT_GT(strict.difference[1], 0.0);
  EXPECT_EQ(chooseLevel(mechanism, 1.001 * strict.difference[1], 5.0, kG).level, Level::kRocker);
  EXPECT_EQ(chooseLevel(mechanism, 0.999 * strict.difference[1], 5.0, kG).level, Level::kLinkage);
  EXPECT_EQ(chooseLevel(mechanism, 1.001 * strict.difference[0], 5.0, kG).level, Level::kPulse);
}

TEST(ChooseLevel, AllowsACheaperLevelForLessCertainParameters) {
  HammerParameters p = drawing();
  const double known = chooseLevel(test::mechanismOf(p), 1.0, 5.0, kG).difference[1];
  for (double& deviation : p.deviations) deviation *= 0.5;
  EXPECT_GT(chooseLevel(test::mechanismOf(p), 1.0, 5.0, kG).difference[1], 1.5 * known);
}

HammerParameters drawingWithRod(const RodSpring& rod) {
  HammerParameters p = drawing();
  p.rod = rod;
  return p;
}

TEST(ChooseLevel, AnElasticRodNeedsElastic) {
  const Mechanism mechanism = test::mechanismOf(drawingWithRod({8e8, 0.3, 0.0}));
  const LevelChoice choice = chooseLevel(mechanism, 0.5, 5.0, kG);
  EXPECT_EQ(choice.level, Level::kElastic);
  EXPECT_GT(choice.difference[2], 1.0);
  EXPECT_GT(choice.difference[1], choice.difference[2]);
  EXPECT_EQ(chooseLevel(mechanism, 1.001 * choice.difference[2], 5.0, kG).level, Level::kLinkage);
  // An unknown rod vibrates as the first guess does. It is rigid if its standard deviations are zero.
  HammerParameters unknown = drawingWithRod({});
  EXPECT_EQ(chooseLevel(test::mechanismOf(unknown), 0.5, 5.0, kG).level, Level::kLinkage);
  unknown.rod_std = usualDeviation(unknown.rod);
  EXPECT_EQ(chooseLevel(test::mechanismOf(unknown), 0.5, 5.0, kG).level, Level::kElastic);
}

/// A boom below 30 Hz responds to means of the load. A nearly rigid rod's vibration has almost no load.
TEST(ChooseLevel, LongMeansAndStiffRodsNeedLess) {
  const Mechanism mechanism = test::mechanismOf(drawingWithRod({8e8, 0.3, 0.0}));
  double before = chooseLevel(mechanism, 0.5, 5.0, kG).difference[2];
  for (const double interval : {1.0 / 60.0, 1.0 / 20.0, 1.0 / 5.0}) {
    const double now = chooseLevel(mechanism, 0.5, 5.0, kG, interval).difference[2];
    EXPECT_LT(now, 0.8 * before) << interval;
    before = now;
  }
  const double stiff = chooseLevel(test::mechanismOf(drawingWithRod({1e15, 0.3, 0.0})), 0.5, 5.0, kG).difference[2];
  EXPECT_LT(stiff, 0.2 * chooseLevel(mechanism, 0.5, 5.0, kG).difference[2]);
}

TEST(ChooseLevel, StatesTheLevelAndTheReasonWithFigures) {
  const std::string line = describe({Level::kRocker, 0.5, false, {12.5, 0.123, 0.0}});
  EXPECT_NE(line.find("rocker is the cheapest"), std::string::npos) << line;
  EXPECT_NE(line.find("within 0.5 of"), std::string::npos) << line;
  EXPECT_NE(line.find("to linkage is"), std::string::npos) << line;
  EXPECT_NE(line.find("pulse 12.5, rocker 0.123, linkage 0"), std::string::npos) << line;
  const std::string elastic = describe({Level::kLinkage, 0.5, true, {12.5, 0.9, 0.4}});
  EXPECT_NE(elastic.find("linkage is the cheapest whose difference to elastic"), std::string::npos) << elastic;
}

}  // namespace
}  // namespace hammer_loads
