// Boom files with wrong bores, closed lengths, hose volumes and IMU position. No reading distinguishes these errors
// from those of oil and sensors, so that the deviations of oil and sensors must cover them.
#include <random>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/util/format.h"
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

constexpr char kBoth[] = "boom_stiffness: identified\nhull_motion: imu\n";

/// Returns keys as from a drawing and a tape measure. Their standard deviations are 0.3 % of a bore, 1 cm of a closed
/// length, a quarter of a hose volume and 2 cm of the IMU's position.
std::string drawnFile(std::mt19937& random) {
  std::normal_distribution<> off;
  const Settings shipped = test::settingsWith(kBoth);
  std::string keys = format("imu_x_m: %.4f\nimu_z_m: %.4f\n", 0.02 * off(random), 0.02 * off(random));
  for (const CylinderParameters& c : shipped.boom->parameters().cylinders) {
    const char* name = c.name.c_str();
    keys += format("%s_bore_m: %.6f\n", name, c.bore * (1.0 + 0.003 * off(random)));
    // The stroke grows by what the closed length loses, so that the same poses are reached.
    const double shorter = 0.01 * std::abs(off(random));
    keys += format("%s_closed_length_m: %.4f\n%s_stroke_m: %.4f\n", name, c.closed_length - shorter, name,
                   c.stroke + shorter);
    keys += format("%s_bore_hose_volume_m3: %.6f\n", name, c.bore_hose_volume * std::exp(0.25 * off(random)));
    keys += format("%s_rod_hose_volume_m3: %.6f\n", name, c.rod_hose_volume * std::exp(0.25 * off(random)));
  }
  return keys;
}

TEST(BoomFileThatIsOff, IsWithinTheDeviationsOfOilAndSensors) {
  std::mt19937 random(97);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  double worst = 0.0, as_given = 0.0;
  for (const bool on_rock : {false, true}) {
    simulation::MachineSettings machine = test::machineOnBoom(between(0.8, 1.25), 50.0, test::drawnPose(between));
    if (on_rock) machine.on_boom.rock = {3e7, 3.0, between(2500.0, 6000.0)};
    const simulation::Session session = simulation::recordSession(machine);
    const accuracy::BoomErrors off = test::errorsOf("file off", session, kBoth + drawnFile(random), {true, true});
    EXPECT_LT(off.worstTorque(), 0.05);
    EXPECT_GT(off.covered(), 0.85);
    EXPECT_GT(off.leastWrenchCovered(), 0.85);
    EXPECT_FALSE(off.warnedOfPressures());
    EXPECT_FALSE(off.warnedOf("rock"));
    worst = std::max(worst, off.worstTorque());
    as_given = std::max(as_given, test::errorsOf("as it is", session, kBoth, {true, true}).worstTorque());
  }
  EXPECT_GT(worst, 1.3 * as_given) << "what is off is seen at all";
}

// Boom and arm bend in their middles, and only an IMU on the hull observes it.

using accuracy::BoomErrors;

BoomErrors byImuAlone(double oil, const test::Pose& pose, double bending_frequency) {
  simulation::MachineSettings machine = test::machineOnBoom(oil, 100.0, pose);
  machine.on_boom.bending_frequency = bending_frequency;
  return test::errorsOf(format("bends with %.0f Hz", bending_frequency), simulation::recordSession(machine),
                        "boom_stiffness: identified\nlevel: rocker\nhull_motion: imu\n", {true, false});
}

/// The mass of a bending link moves less than its joint indicates. The error is up to 14 % of a torque that is a small
/// difference of large ones.
TEST(BendingLinks, AreInTheDeviationsOfAnImuAlone) {
  double worst = 0.0;
  const std::array<test::Pose, 2> poses{{{-0.45, 1.00, -0.50}, {-0.70, 1.55, -0.75}}};
  for (const test::Pose& pose : poses) {
    const BoomErrors e = byImuAlone(1.2, pose, 14.0);
    EXPECT_GT(e.covered(), 0.88) << pose[0];
    EXPECT_GT(e.sectionsCovered(), 0.75) << pose[0];
    worst = std::max(worst, e.worstTorque());
    const BoomErrors rigid = byImuAlone(1.2, pose, 0.0);
    EXPECT_LT(rigid.worstTorque(), 0.02);
    EXPECT_GT(rigid.covered(), 0.95);
    for (int j = 0; j < 3; ++j)
      EXPECT_LT(std::sqrt(rigid.torque_stated[j] / rigid.torque[j].square) * rigid.torque[j].rms(), 0.2) << j;
  }
  EXPECT_GT(worst, 0.04);
}

}  // namespace
}  // namespace hammer_loads
