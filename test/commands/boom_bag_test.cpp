/// process_bag with a robot description, as its user runs it, on bags written here.
#include "commands/boom_bag.h"

namespace hammer_loads {
namespace {

using test::BoomBag;
using test::InputBag;
using test::kSide;
using test::machineOfBag;

std::map<std::string, std::size_t> countsOf(const test::Recorded& recorded) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [topic, messages] : recorded) counts[topic] = messages.size();
  return counts;
}

TEST_F(BoomBag, HoldsEveryOutputAsTheLiveFlowGivesItAndIsByteIdenticalOnASecondRun) {
  const simulation::Session session = simulation::recordSession(machineOfBag(true));
  InputBag(path("in.bag"), session);
  // The session's hull stands still: the model's motion and the drive's reaction together would contradict it.
  const std::string parameters =
      "boom_wrench_links: [arm_link, strain_gauge]\nboom: compliant\nhull_motion: model\ndrive_reaction_ratio: 0.0\n";
  const test::Outcome outcome = process("out.bag", parameters);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const test::Recorded written = test::recordedIn(path("out.bag"));
  auto counts = countsOf(written);
  const std::size_t samples = session.crank.size();
  // Before the first joint states and beyond the last transform nothing is known: 20 ms at most each. Beside a blow
  // nothing is published: in the first turns of these 2.5 s the zero is not known.
  const std::size_t beside = samples / 50;
  for (const char* topic : {"boom_wrench/arm_link", "joint_loads", "section_loads", "joint_reactions", "boom_vibration",
                            "boom_wrench/strain_gauge"}) {
    EXPECT_GE(counts[topic], samples - 40 - beside) << topic;
    EXPECT_LT(counts[topic], samples) << topic;
  }
  EXPECT_GE(counts["hull_wrench"], samples - beside);
  for (const char* topic : {"hull_loads", "pin_forces"}) EXPECT_EQ(counts[topic], counts["hull_wrench"]);
  EXPECT_LE(counts["mechanism"], samples / 10 + 1) << "at most 100 Hz";
  EXPECT_GE(counts["mechanism"], (samples - 10 * beside) / 10);
  EXPECT_GE(counts["blow"], 8U);
  EXPECT_EQ(counts["pulse"], counts["blow"] - 1);
  EXPECT_EQ(counts["run_info"], 1U);
  EXPECT_EQ(counts.size(), 15U);

  const test::Recorded right = live(parameters);
  EXPECT_EQ(countsOf(right), counts);
  EXPECT_TRUE(written == right);

  ASSERT_EQ(process("again.bag", parameters).exit_code, 0);
  const std::string bytes = test::contentOf(path("out.bag"));
  EXPECT_GT(bytes.size(), 1000000U);
  EXPECT_TRUE(bytes == test::contentOf(path("again.bag")));
}

/// By hand: from the gauge's frame to D, on the hammer joint's angle between its two states.
TEST_F(BoomBag, StatesTheLoadAtATfFrameWithItsLeverArm) {
  const simulation::Session session = simulation::recordSession(machineOfBag(true));
  InputBag(path("in.bag"), session);
  ASSERT_EQ(process("out.bag", "boom_wrench_links: [strain_gauge]\n").exit_code, 0);
  const auto hull = test::wrenchesIn(path("out.bag"), "/hammer_loads/hull_wrench");
  const auto gauge = test::wrenchesIn(path("out.bag"), "/hammer_loads/boom_wrench/strain_gauge");
  ASSERT_GT(gauge.size(), 2400U);
  double largest = 0.0;
  std::size_t next = 1;
  for (const auto& [stamp, told] : gauge) {
    while (next + 1 < session.joints.size() && session.joints[next].stamp < stamp) ++next;
    const simulation::JointReading &before = session.joints[next - 1], &after = session.joints[next];
    const double part = static_cast<double>(stamp - before.stamp) / static_cast<double>(after.stamp - before.stamp);
    const double angle = before.position[3] + part * (after.position[3] - before.position[3]);
    const double c = std::cos(angle), s = std::sin(angle);
    const geometry_msgs::Wrench& w = hull.at(stamp);
    const double force_x = c * w.force.x + s * w.force.z, force_z = -s * w.force.x + c * w.force.z;
    const double x = kSide + 1.70 + 0.10 * c - 0.55 * s, z = -0.10 * s - 0.55 * c;
    const double torque = w.torque.y + z * force_x - x * force_z;
    // Slerp of half angles 0.02 rad apart and quaternions that TF rounds: 1e-12 of the load.
    ASSERT_NEAR(told.force.x, force_x, 1e-8) << stamp;
    ASSERT_NEAR(told.force.z, force_z, 1e-8) << stamp;
    ASSERT_NEAR(told.torque.y, torque, 1e-8) << stamp;
    largest = std::max(largest, std::abs(torque));
  }
  EXPECT_GT(largest, 1e4) << "some 8 kN at some 2.5 m";
}

}  // namespace
}  // namespace hammer_loads
