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

}  // namespace
}  // namespace hammer_loads
