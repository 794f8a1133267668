/// Weight on a base that leans, with and without a description.
#include "hammer_loads/pipeline/hull_gravity.h"

#include <gtest/gtest.h>

#include "support/constants.h"
#include "support/session_player.h"

namespace hammer_loads {
namespace {

using test::kFour;
constexpr double kG = 9.80665;

HullGravity gravityWith(const std::string& keys, bool with_boom) {
  const Settings settings = test::settingsWith(keys);
  return HullGravity(settings.pipeline, with_boom ? settings.boom : std::nullopt);
}

TEST(HullGravity, TakesTheBasesPitchLikeAJoints) {
  for (const bool with_boom : {false, true}) {
    HullGravity level = gravityWith("base_pitch_rad: 0.0\n", with_boom),
                leans = gravityWith("base_pitch_rad: 0.3\n", with_boom);
    level.joints(kFour, {0.0, -0.2, 1.2, -0.8});
    leans.joints(kFour, {0.0, -0.2, 0.9, -0.8});
    EXPECT_NEAR(level.gravity().x, kG * std::sin(0.2), 1e-12);
    EXPECT_NEAR(leans.gravity().x, level.gravity().x, 1e-12);
    EXPECT_NEAR(leans.gravity().z, level.gravity().z, 1e-12);
  }
}

TEST(HullGravity, SwingCountsWithADescriptionAlone) {
  HullGravity with = gravityWith("base_roll_rad: 0.2\n", true), without = gravityWith("base_roll_rad: 0.2\n", false);
  for (HullGravity* g : {&with, &without}) g->joints(kFour, {1.5707963267948966, 0.0, 0.0, 0.0});
  // Swung by a quarter turn to the left, what rolls the machine to its right pitches the hull back.
  EXPECT_NEAR(with.gravity().x, -kG * std::sin(0.2), 1e-12);
  EXPECT_NEAR(without.gravity().x, 0.0, 1e-12);
  EXPECT_NEAR(with.gravity().z, -kG * std::cos(0.2), 1e-12);
}

TEST(HullGravity, UntilEveryJointHasBeenHeardItIsThatOfThePitch) {
  HullGravity gravity = gravityWith("hull_pitch_rad: 0.4\n", true);
  EXPECT_FALSE(gravity.joints({"swing_joint"}, {1.0}));
  EXPECT_NEAR(gravity.gravity().x, kG * std::sin(0.4), 1e-12);
  EXPECT_TRUE(gravity.joints({"boom_joint", "arm_joint", "hammer_joint"}, {0.1, 0.2, 0.3}));
  EXPECT_NEAR(gravity.gravity().x, kG * std::sin(0.6), 1e-12);
}

}  // namespace
}  // namespace hammer_loads
