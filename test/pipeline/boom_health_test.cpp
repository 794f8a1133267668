// Oil stiffness shown by a boom's vibration at the end of each revolution, against the true one and from day to day.
#include "hammer_loads/pipeline/boom_health.h"

#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

constexpr char kOilFound[] = "boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n";
constexpr std::array<double, 3> kSite{-0.4, 1.1, -0.7};

simulation::MachineSettings onSite(double oil, std::array<double, 3> of_cylinder, unsigned seed,
                                   const std::array<double, 3>& pose = kSite) {
  simulation::MachineSettings m = test::machineOnBoom(oil, 50.0, pose);
  m.seed = seed;
  m.on_boom.cylinder_oil = of_cylinder;
  return m;
}

/// Returns the boom's health at the end of each revolution from 2 s on.
std::vector<BoomHealth> healthOf(const simulation::MachineSettings& machine, const char* keys = kOilFound) {
  const simulation::Session session = simulation::recordSession(machine);
  const Settings settings = test::withExactHammer(test::settingsWith(keys));
  test::Player player(settings, true, session);
  player.imu_speaks = player.pressures_speak = true;
  std::vector<BoomHealth> turns;
  player.playTo(test::kJudgedTo, [&](double time, const SampleResult& result) {
    if (time < 2.0 || result.turn_ends == 0) return;
    if (const auto health = boomHealth(*player.pipeline.boom())) turns.push_back(*health);
  });
  return turns;
}

TEST(BoomHealth, FindsEachCylindersOilAndTheModes) {
  const std::array<double, 3> oil{0.8, 1.0, 1.25};
  for (const double common : {0.85, 1.1}) {
    const std::vector<BoomHealth> turns = healthOf(onSite(common, oil, 31));
    ASSERT_GT(turns.size(), 5U);
    for (const BoomHealth& turn : turns) {
      ASSERT_EQ(turn.count, 3);
      EXPECT_TRUE(turn.oil_explains);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(turn.cylinder[i].joint_angle, kSite[i], 0.1);  // the operator moves the joint
        EXPECT_NEAR(turn.cylinder[i].stiffness, common * oil[i], 0.06 * common * oil[i]) << i;
        EXPECT_LT(turn.cylinder[i].deviation, 0.06);
        EXPECT_GT(turn.mode[i].deviation, 0.0);
        EXPECT_GT(turn.mode[i].damping, 0.0);
      }
      EXPECT_LT(turn.mode[0].frequency, turn.mode[1].frequency);
      EXPECT_LT(turn.mode[1].frequency, turn.mode[2].frequency);
    }
  }
}

/// On another day, with another pose and other noise, a change is recognised and all else keeps its value.
TEST(BoomHealth, ShowsWhatHasChangedAndNothingElse) {
  const std::array<double, 3> moved{-0.55, 1.3, -0.85};
  const BoomHealth before = healthOf(onSite(1.0, {1.0, 1.0, 1.0}, 41)).back();
  for (std::size_t soft = 0; soft < 3; ++soft) {
    std::array<double, 3> oil{1.0, 1.0, 1.0};
    oil[soft] = 0.75;
    const BoomHealth after = healthOf(onSite(1.0, oil, 42 + static_cast<unsigned>(soft), moved)).back();
    for (std::size_t i = 0; i < 3; ++i) {
      const double change = after.cylinder[i].stiffness / before.cylinder[i].stiffness - 1.0;
      const double doubt = std::hypot(after.cylinder[i].deviation, before.cylinder[i].deviation);
      std::printf("%zu soft, cylinder %zu: %+.1f %%, deviation %.1f %%\n", soft, i, 100.0 * change, 100.0 * doubt);
      EXPECT_NEAR(change, oil[i] - 1.0, 3.0 * doubt) << i;
      EXPECT_EQ(std::abs(change) > 3.0 * doubt, i == soft) << i;
    }
  }
}

TEST(BoomHealth, IsNotKnownOfABoomAsItsFileHasIt) {
  EXPECT_TRUE(healthOf(onSite(1.0, {1.0, 1.0, 1.0}, 51), "boom: compliant\nhull_motion: imu\n").empty());
}

/// The machine has additional dampers, with four times the damping of the boom file.
TEST(BoomHealth, NamesWhereSomethingElseThanOilDamps) {
  simulation::MachineSettings m = onSite(1.0, {1.0, 1.0, 1.0}, 61);
  m.on_boom.damping = 0.2;
  const std::vector<BoomHealth> turns = healthOf(m);
  ASSERT_FALSE(turns.empty());
  EXPECT_FALSE(turns.back().oil_explains);
}

}  // namespace
}  // namespace hammer_loads
