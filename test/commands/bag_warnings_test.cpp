/// Final report of process_bag: missing inputs, suspicious inputs, amount written.
#include <geometry_msgs/WrenchStamped.h>
#include <hammer_loads/HullLoads.h>
#include <topic_tools/shape_shifter.h>

#include <optional>
#include <utility>

#include "boom/booms.h"
#include "commands/bag_files.h"
#include "hammer_loads/settings/load.h"
#include "support/known_zero.h"

namespace hammer_loads {
namespace {

using test::kSession;

constexpr char kMissingHammer[] = "warning: no hammer file was given";

class BagWarnings : public test::BagFiles {
 protected:
  using Change = std::function<void(rosbag::Bag&, const rosbag::MessageInstance&)>;
  /// Writes the session to a bag, each message through `write`.
  std::string session(const std::string& name, const Change& write) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    test::forEachOfSession([&](const rosbag::MessageInstance& item) { write(bag, item); });
    return path(name);
  }
  /// Returns the stderr of a run with a given hammer file.
  std::string warnings(const std::string& in, const std::string& more = {}) const {
    const test::Outcome outcome = run(in + " " + path("out_" + std::to_string(names().size()) + ".bag") + " --params " +
                                      configDirectory() + "/hammer_mo100.yaml" + more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(test::linesOf(outcome.out).size(), 1U) << outcome.out;
    return outcome.err;
  }
  static void expectWarned(const std::string& warnings, const std::vector<std::string>& words) {
    EXPECT_EQ(test::linesOf(warnings).size(), 1U) << warnings;
    for (const std::string& word : words) EXPECT_NE(warnings.find(word), std::string::npos) << warnings;
  }
};

TEST_F(BagWarnings, AGoodRecordingGivesNoneAndOneLineStatesWhatWasWritten) {
  const test::TemporaryFile known_zero(kKnownZeroYaml);
  const test::Outcome outcome = run(kSession + " " + path("out.bag") + " --params " + configDirectory() +
                                    "/hammer_mo100.yaml --params " + known_zero.path());
  EXPECT_EQ(outcome.err, "");
  unsigned wrenches = 0;
  const std::string begin = path("out.bag") + ": 2979 crank samples, ";
  ASSERT_EQ(outcome.out.rfind(begin, 0), 0U) << outcome.out;
  std::sscanf(outcome.out.c_str() + begin.size(), "%u", &wrenches);
  EXPECT_EQ(outcome.out, begin + std::to_string(wrenches) + " wrenches, 122 turns, written under /hammer_loads\n");
  EXPECT_GT(wrenches, 0.99 * 2979) << "samples beside a blow have none";
}

TEST_F(BagWarnings, AnUnknownZeroGivesNoneEither) {
  EXPECT_EQ(warnings(kSession), "") << "the first revolutions show it";
}

TEST_F(BagWarnings, AHammerFileThatWasNotGivenIsNamed) {
  const test::TemporaryFile no_hammer("level: linkage\n");
  for (const std::string& params : {std::string(), " --params " + no_hammer.path()}) {
    const test::Outcome outcome = run(kSession + " " + path("out.bag") + " --force" + params);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.err.find(kMissingHammer), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("MO-100"), std::string::npos) << outcome.err;
  }
}

TEST_F(BagWarnings, JointStatesThatNeverCameAreNamedWithTheTopicsThere) {
  const std::string in = session("in.bag", [](rosbag::Bag& bag, const rosbag::MessageInstance& item) {
    bag.write(item.getTopic() == "/hammer/crank" ? item.getTopic() : "/machine/joints", item.getTime(), item);
  });
  expectWarned(warnings(in), {"warning: no message on /joint_states", "/machine/joints"});
  EXPECT_EQ(warnings(in, " --joint-states-topic /machine/joints"), "");
  const test::TemporaryFile vertical("pitch_joints: []\n");
  EXPECT_EQ(warnings(in, " --params " + vertical.path()), "") << "none is wanted";
}

TEST_F(BagWarnings, AJointThatNeverCameIsNamed) {
  const std::string in = session("in.bag", [](rosbag::Bag& bag, const rosbag::MessageInstance& item) {
    sensor_msgs::JointState m = *item.instantiate<sensor_msgs::JointState>();
    for (std::string& name : m.name) name = name == "arm_joint" ? "stick_joint" : name;
    bag.write(item.getTopic(), item.getTime(), m);
  });
  expectWarned(warnings(in), {"warning: /joint_states: no angle of arm_joint"});
}

TEST_F(BagWarnings, TwoPublishersOnOneTopicAreNamed) {
  int count = 0;
  const std::string in = session("in.bag", [&](rosbag::Bag& bag, const rosbag::MessageInstance& item) {
    const bool crank = item.getTopic() == "/hammer/crank";
    const char* node = !crank ? "/boom" : ++count % 50 == 0 ? "/old_driver" : "/driver";
    test::writeFrom(bag, node, item.getTopic(), item.getTime(), *item.instantiate<sensor_msgs::JointState>());
  });
  expectWarned(warnings(in), {"warning: /hammer/crank: several publishers: /driver, /old_driver"});
}

/// Half of the day is valid. Its loads are written as the node had them, but ledger and tables reject the day.
TEST_F(BagWarnings, ARecordingPartlyInDegreesGivesItsLoadsButNoFigures) {
  std::optional<ros::Time> begin;
  const ros::Duration good(15.0);
  const std::string in = session("in.bag", [&](rosbag::Bag& bag, const rosbag::MessageInstance& item) {
    sensor_msgs::JointState m = *item.instantiate<sensor_msgs::JointState>();
    if (!begin) begin = item.getTime();
    const bool in_degrees = item.getTime() - *begin > good && item.getTopic() == "/hammer/crank";
    for (double& angle : m.position) angle *= in_degrees ? 57.29577951308232 : 1.0;
    bag.write(item.getTopic(), item.getTime(), m);
  });
  const std::string hammer = " --params " + configDirectory() + "/hammer_mo100.yaml";
  const std::string out = path("partly.bag"), right = path("right.bag");
  const test::Outcome outcome = run(in + " " + out + hammer);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: crank: angle or speed is in degrees"), std::string::npos) << outcome.err;
  ASSERT_EQ(run(kSession + " " + right + hammer).exit_code, 0);
  const auto wrenches = [&](const std::string& name) {
    std::vector<std::pair<ros::Time, double>> found;
    rosbag::Bag bag(name);
    for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery("/hammer_loads/hull_wrench")))
      if (item.getTime() <= *begin + good)
        found.emplace_back(item.getTime(), item.instantiate<geometry_msgs::WrenchStamped>()->wrench.force.z);
    return found;
  };
  EXPECT_GT(wrenches(out).size(), 1400U);
  EXPECT_EQ(wrenches(out), wrenches(right));
  expectRefused(run("--no-bag " + in + " --db " + path("tables.sqlite") + hammer), {"no tables", "in degrees"});
  expectRefused(run("--no-bag " + in + " --ledger " + path("ledger.sqlite") + hammer),
                {"is not counted", "in degrees"});
  expectRefused(run(in + " " + path("both.bag") + " --ledger " + path("ledger.sqlite") + hammer), {"is not counted"});
  EXPECT_FALSE(std::filesystem::exists(path("both.bag"))) << "together or not at all";
}

TEST_F(BagWarnings, OutputsOfAnotherVersionAreNamed) {
  const std::string in = session("in.bag", [](rosbag::Bag& bag, const rosbag::MessageInstance& item) {
    bag.write(item.getTopic(), item.getTime(), item);
  });
  {
    rosbag::Bag bag(in, rosbag::bagmode::Append);
    topic_tools::ShapeShifter old;
    old.morph("0123456789abcdef0123456789abcdef", "hammer_loads/HullLoads", "float64 force_x\n", "0");
    std::vector<std::uint8_t> bytes(8, 0);
    ros::serialization::IStream stream(bytes.data(), 8);
    old.read(stream);
    bag.write("/hammer_loads/hull_loads", ros::Time(1700000001.0), old);
  }
  expectWarned(warnings(in), {"warning: messages of another version of this package cannot be read: "
                              "/hammer_loads/hull_loads (hammer_loads/HullLoads)"});
  {
    rosbag::Bag bag(in, rosbag::bagmode::Append);
    bag.write("/hammer_loads/again", ros::Time(1700000001.0), HullLoads());
  }
  EXPECT_EQ(warnings(in).find("/hammer_loads/again"), std::string::npos);
}

}  // namespace
}  // namespace hammer_loads
