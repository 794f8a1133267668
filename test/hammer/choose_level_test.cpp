#include "hammer_loads/hammer/choose_level.h"

#include <gtest/gtest.h>

#include "support/mo100.h"

namespace hammer_loads {
namespace {

constexpr double kG = 9.80665;

TEST(ChooseLevel, AMasslessCrankAndRodNeedNoLinkage) {
  const LevelChoice choice = chooseLevel(test::mechanismOf(test::mo100Parameters()), 1e-12, 5.0, kG);
  EXPECT_EQ(choice.level, Level::kRocker);
  EXPECT_LT(choice.error[1], 1e-13);
  EXPECT_GT(choice.error[0], 0.9) << "the pulse has neither Fx nor moment";
}

TEST(ChooseLevel, TakesTheCheapestWithinTolerance) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const LevelChoice strict = chooseLevel(mechanism, 1e-6, 5.0, kG);
  EXPECT_EQ(strict.level, Level::kLinkage);
  ASSERT_GT(strict.error[1], 0.0);
  EXPECT_EQ(chooseLevel(mechanism, 1.001 * strict.error[1], 5.0, kG).level, Level::kRocker);
  EXPECT_EQ(chooseLevel(mechanism, 0.999 * strict.error[1], 5.0, kG).level, Level::kLinkage);
  EXPECT_EQ(chooseLevel(mechanism, 1.001 * strict.error[0], 5.0, kG).level, Level::kPulse);
}

TEST(ChooseLevel, JudgesByTheTurnsRateBecauseWeightDoesNotGrowWithIt) {
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const double slow = chooseLevel(mechanism, 1.0, 1.0, kG).error[1];
  const double fast = chooseLevel(mechanism, 1.0, 20.0, kG).error[1];
  EXPECT_GT(slow, fast);
  EXPECT_NEAR(chooseLevel(mechanism, 1.0, 1.0, 0.0).error[1], chooseLevel(mechanism, 1.0, 20.0, 0.0).error[1], 1e-12);
}

TEST(ChooseLevel, SaysWhichAndWhyWithTheFigures) {
  const std::string line = describe({Level::kRocker, 0.02, {1.25, 0.0123}});
  EXPECT_NE(line.find("rocker is the cheapest within tolerance 2 %"), std::string::npos) << line;
  EXPECT_NE(line.find("pulse 125 %, rocker 1.23 %"), std::string::npos) << line;
}

}  // namespace
}  // namespace hammer_loads
