// Tests the rock's force on a hull that stands on it, from pressures and IMU. Other effects must not be taken for it,
// nor it for other effects.
#include <random>

#include "hammer_loads/pipeline/warnings.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

constexpr char kByBoth[] = "hull_motion: imu\nboom_stiffness: identified\n";

/// Draws pose, oil and rock.
simulation::MachineSettings drawnOnRock(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const test::Pose pose = test::drawnPose(between);
  simulation::MachineSettings m = test::machineOnBoom(between(0.75, 1.3), 50.0, pose);
  m.seed = 300 + seed;
  m.on_boom.rock = {between(1e7, 6e7), 3.0, between(3e3, 6e3)};
  return m;
}

/// Bending links, worn pins, seals, air and a leak shift the mean of pressures. Rock does not pull: an apparent pull is
/// an error of the pressures. Without this rule three machines had 91 to 94 % of the force wrong. Their flag of a lost
/// hold-down force was right in 21 to 26 % of the samples.
TEST(RocksForce, IsNoneBetweenLandings) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    simulation::MachineSettings m = drawnOnRock(seed);
    m.on_boom.seals.friction = 0.01;
    m.on_boom.bending_frequency = 30.0;
    m.on_boom.air = 0.008;
    m.on_boom.pin_play = 1.2e-4;
    m.on_boom.leak = 1e-13;
    const simulation::Session session = simulation::recordSession(m);
    const accuracy::BoomErrors e = test::errorsOf("worn", session, kByBoth, {true, true});
    std::printf("  %.0f %% of the force\n", 100.0 * e.contact.rms());
    EXPECT_LT(e.contact.rms(), 0.4) << seed;
    EXPECT_GT(e.part(e.lost_as_shown), 0.7) << seed;
    EXPECT_LT(e.worstTorque(), 0.15) << seed;
    EXPECT_GT(e.covered(), 0.85) << seed;
    EXPECT_FALSE(e.warnedOf("pressure stamps")) << "which are right";
  }
}

/// Nothing is learned of the oil before the first blow. The offset of a gyroscope used to turn the boom away: with this
/// oil and pose by three times its static deflection within a second. Pressures were then rejected.
TEST(RocksForce, DoesNotGrowOnABoomAtRest) {
  simulation::MachineSettings m = test::machineOnBoom(0.758, 50.0, {-0.654, 0.772, 0.036});
  m.on_boom.rock = {1.77e7, 3.0, 3550.0};
  m.duration = 3.0;
  for (unsigned seed = 4; seed <= 5; ++seed) {
    m.seed = seed;
    const simulation::Session session = simulation::recordSession(m);
    const Settings settings = test::withExactHammer(test::settingsWith(std::string("boom: compliant\n") + kByBoth));
    test::Player player(settings, true, session);
    double farthest = 0.0, hangs = 0.0;
    std::size_t i = 0, distrusted = 0;
    player.playTo(3.0, [&](double time, const SampleResult&) {
      const simulation::OnBoomTruth& truth = session.on_boom[i++];
      const BoomFollower& boom = *player.pipeline.boom();
      distrusted += boom.pressureTrust().isLost();
      if (time < 1.2 || time > 2.0) return;
      const Eigen::Vector3d right = m.on_boom.oil_stiffness * truth.displacement;  // with oil as in the file
      farthest = std::max(farthest, (boom.boom().vibration().displacement().tail<3>() - right).norm());
      hangs = right.norm();
    });
    std::printf("%.2f mrad off of %.2f, distrusted for %zu samples\n", 1e3 * farthest, 1e3 * hangs, distrusted);
    EXPECT_LT(farthest, 0.5 * hangs) << seed;
    EXPECT_EQ(distrusted, 0U) << seed;
  }
}

}  // namespace
}  // namespace hammer_loads
