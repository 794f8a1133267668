#include "hammer_loads/simulation/session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

MachineSettings quietRun() {
  MachineSettings s = workingMo100();
  s.duration = 4.0;
  s.drive.start_time = 0.7;
  s.drive.stop_time = 9.0;
  return s;
}

void expectSame(const Session& a, const Session& b) {
  ASSERT_EQ(a.crank.size(), b.crank.size());
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t i = 0; i < a.crank.size(); ++i) {
    ASSERT_EQ(a.crank[i].stamp, b.crank[i].stamp);
    ASSERT_EQ(a.crank[i].angle, b.crank[i].angle);
    ASSERT_EQ(a.crank[i].speed, b.crank[i].speed);
  }
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    ASSERT_EQ(a.joints[i].stamp, b.joints[i].stamp);
    ASSERT_EQ(a.joints[i].position, b.joints[i].position);
  }
}

TEST(Session, GivesEqualReadingsForOneSeed) { expectSame(recordSession(quietRun()), recordSession(quietRun())); }

TEST(Session, JointsGiveTheTruthsPitch) {
  const MachineSettings s = quietRun();
  const Session session = recordSession(s);
  const double h = 1e-4;
  double largest = 0.0;
  for (const JointReading& joints : session.joints) {
    const double t = static_cast<double>(joints.stamp - s.start_stamp) * 1e-9;
    const double pitch = joints.position[1] + joints.position[2] + joints.position[3];
    const double rate = joints.velocity[1] + joints.velocity[2] + joints.velocity[3];
    ASSERT_NEAR(pitch, hullPitch(s, t), 1e-8);
    ASSERT_NEAR(rate, (hullPitch(s, t + h) - hullPitch(s, t - h)) / (2.0 * h), 1e-8);
    largest = std::max(largest, std::abs(pitch));
  }
  EXPECT_GT(largest, 0.02);
  EXPECT_LT(largest, 0.2);
}

}  // namespace
}  // namespace hammer_loads::simulation
