/// Weight on a base that leans, with and without a description.
#include <gtest/gtest.h>

#include "hammer_loads/pipeline/hull_state.h"
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
  // After a swing of 90 deg to the left, a roll of the machine to its right pitches the hull back.
  EXPECT_NEAR(with.gravity().x, -kG * std::sin(0.2), 1e-12);
  EXPECT_NEAR(without.gravity().x, 0.0, 1e-12);
  EXPECT_NEAR(with.gravity().z, -kG * std::cos(0.2), 1e-12);
}

TEST(HullGravity, IsThatOfThePitchUntilEveryJointIsReceived) {
  HullGravity gravity = gravityWith("hull_pitch_rad: 0.4\n", true);
  EXPECT_FALSE(gravity.joints({"swing_joint"}, {1.0}));
  EXPECT_NEAR(gravity.gravity().x, kG * std::sin(0.4), 1e-12);
  EXPECT_TRUE(gravity.joints({"boom_joint", "arm_joint", "hammer_joint"}, {0.1, 0.2, 0.3}));
  EXPECT_NEAR(gravity.gravity().x, kG * std::sin(0.6), 1e-12);
}

/// Returns the rotation matrix about a coordinate axis.
Eigen::Matrix3d turned(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  R(a, a) = c, R(a, b) = -s, R(b, a) = s, R(b, b) = c;
  return R;
}

/// Returns a description by a machine's maker: own names, joints about -y or +y with own zeros, no masses.
/// ends_in_hull: the link beyond the last joint carries hammer_hull, turned by 0.25 rad.
std::string strangersUrdf(bool ends_in_hull) {
  std::string urdf = R"(<robot name="other">
  <link name="chassis"/><link name="tower"/><link name="lift"/><link name="stick"/><link name="plate"/>
  <joint name="slew" type="revolute"><parent link="chassis"/><child link="tower"/><origin xyz="0 0 1"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j_lift" type="revolute"><parent link="tower"/><child link="lift"/><origin rpy="0 -0.6 0"/>
    <axis xyz="0 -1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j_stick" type="revolute"><parent link="lift"/><child link="stick"/><origin xyz="2 0 0" rpy="0 1.9 0"/>
    <axis xyz="0 -1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j_tool" type="revolute"><parent link="stick"/><child link="plate"/><origin xyz="2 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
)";
  if (ends_in_hull)
    urdf += R"(<link name="hammer_hull"/><joint name="bolts" type="fixed"><parent link="plate"/>
    <child link="hammer_hull"/><origin rpy="0 0.25 0"/></joint>)";
  return urdf + "</robot>\n";
}

const std::string kStrangersJoints = "pitch_joints: [j_lift, j_stick, j_tool]\nbase_roll_rad: 0.08\n";
const std::vector<std::string> kStrangersNames{"slew", "j_lift", "j_stick", "j_tool"};

Settings strangersSettings(const std::string& keys, const std::string& urdf) {
  const test::TemporaryFile file(keys);
  const Checked<Settings> settings = loadFiles(configDirectory(), {file.path()}, urdf);
  if (!settings.value) throw std::runtime_error(settings.problems.front());
  return *settings.value;
}

TEST(HullGravity, AStrangersDescriptionGivesAxesAndZerosWithoutABoomFile) {
  const double lift = 0.31, stick = -0.42, tool = 0.17, slew = 0.9;
  const Eigen::Matrix3d R_CP = turned(2, slew) * turned(1, -0.6 - lift) * turned(1, 1.9 - stick) * turned(1, tool);
  for (const bool boom_none : {false, true}) {
    for (const bool ends_in_hull : {false, true}) {
      const std::string offset = "pitch_offset_rad: 0.25\n";  // which the link hammer_hull gives by itself
      const Settings settings =
          strangersSettings(kStrangersJoints + offset + (boom_none ? "boom: none\n" : ""), strangersUrdf(ends_in_hull));
      ASSERT_FALSE(settings.boom);
      HullGravity gravity(settings.pipeline, settings.boom);
      EXPECT_TRUE(gravity.joints(kStrangersNames, {slew, lift, stick, tool}));
      const Eigen::Vector3d g_H =
          (turned(0, 0.08) * R_CP * turned(1, 0.25)).transpose() * Eigen::Vector3d(0.0, 0.0, -kG);
      EXPECT_NEAR(gravity.gravity().x, g_H.x(), 1e-12);
      EXPECT_NEAR(gravity.gravity().z, g_H.z(), 1e-12);
      EXPECT_NEAR(gravity.pitch().pitch(), -0.6 - lift + 1.9 - stick + tool + 0.25, 1e-12);
    }
  }
}

TEST(HullGravity, SignsAndOffsetStandForADescription) {
  const double lift = 0.31, stick = -0.42, tool = 0.17;
  const Settings settings =
      strangersSettings(kStrangersJoints + "pitch_signs: [-1, -1, 1]\npitch_offset_rad: 1.55\n", "");
  const Settings described = strangersSettings(kStrangersJoints + "pitch_offset_rad: 0.25\n", strangersUrdf(false));
  HullGravity by_keys(settings.pipeline, std::nullopt), by_description(described.pipeline, std::nullopt);
  for (HullGravity* g : {&by_keys, &by_description}) g->joints(kStrangersNames, {0.0, lift, stick, tool});
  EXPECT_NEAR(by_keys.gravity().x, kG * std::cos(0.08) * std::sin(1.55 - lift - stick + tool), 1e-12);
  EXPECT_NEAR(by_keys.gravity().x, by_description.gravity().x, 1e-12);
  EXPECT_NEAR(by_keys.gravity().z, by_description.gravity().z, 1e-12);
}

TEST(HullGravity, SignsThatContradictTheDescriptionAreRefused) {
  const test::TemporaryFile good(kStrangersJoints + "pitch_signs: [-1, -1, 1]\n"),
      bad(kStrangersJoints + "pitch_signs: [-1, 1, 1]\n");
  EXPECT_TRUE(loadFiles(configDirectory(), {good.path()}, strangersUrdf(true)).value);
  const Checked<Settings> refused = loadFiles(configDirectory(), {bad.path()}, strangersUrdf(true));
  ASSERT_EQ(refused.problems.size(), 1U);
  EXPECT_EQ(refused.problems[0].rfind("pitch_signs: 1 for j_stick, must be -1 as its axis in the robot description", 0),
            0U)
      << refused.problems[0];
}

TEST(HullGravity, ADescriptionWithoutThePitchJointsIsNotUsed) {
  const Settings settings = strangersSettings("hull_pitch_rad: 0.1\n", strangersUrdf(true));
  HullGravity gravity(settings.pipeline, std::nullopt);
  gravity.joints(kStrangersNames, {0.9, 0.3, 0.2, 0.1});
  EXPECT_NEAR(gravity.gravity().x, kG * std::sin(0.1), 1e-12);
  EXPECT_EQ(gravity.pitch().unheard(), settings.pipeline.pitch_joints);
}

}  // namespace
}  // namespace hammer_loads
