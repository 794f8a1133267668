// Boom and arm that bend in their middles, seen by an IMU on the hull alone: torques of joints, and how far off they
// are.
#include "pipeline/on_boom_session.h"

namespace hammer_loads {
namespace {

using accuracy::BoomErrors;

BoomErrors byImuAlone(double oil, const test::Pose& pose, double bending_frequency) {
  simulation::MachineSettings machine = test::machineOnBoom(oil, 100.0, pose);
  machine.on_boom.bending_frequency = bending_frequency;
  return test::errorsOf(format("bends with %.0f Hz", bending_frequency), simulation::recordSession(machine),
                        "boom_stiffness: identified\nlevel: rocker\nhull_motion: imu\n", {true, false});
}

/// Each link's own mass moves less than its joint says: up to 14 % of a torque that is a small difference of large
/// ones.
TEST(BendingLinks, AreInTheDeviationsOfAnImuAlone) {
  double worst = 0.0;
  const std::array<test::Pose, 3> poses{{{-0.45, 1.00, -0.50}, {-0.70, 1.55, -0.75}, {-0.20, 0.80, -0.70}}};
  for (const test::Pose& pose : poses) {
    for (const double frequency : {14.0, 19.0}) {
      const BoomErrors e = byImuAlone(1.2, pose, frequency);
      EXPECT_GT(e.covered(), 0.88) << pose[0] << ' ' << frequency;
      EXPECT_GT(e.sectionsCovered(), 0.75) << pose[0] << ' ' << frequency;
      worst = std::max(worst, e.worstTorque());
    }
    const BoomErrors rigid = byImuAlone(1.2, pose, 0.0);
    EXPECT_LT(rigid.worstTorque(), 0.02);
    EXPECT_GT(rigid.covered(), 0.95);
    for (int j = 0; j < 3; ++j)
      EXPECT_LT(std::sqrt(rigid.torque_said[j] / rigid.torque[j].square) * rigid.torque[j].rms(), 0.2) << j;
  }
  EXPECT_GT(worst, 0.04);
}

}  // namespace
}  // namespace hammer_loads
