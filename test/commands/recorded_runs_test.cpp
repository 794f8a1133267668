/// process_bag on a node's log uses the parameters, robot description and topics of each run_info.
#include <hammer_loads/HullLoads.h>
#include <topic_tools/shape_shifter.h>

#include "boom/booms.h"
#include "commands/bag_files.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

using test::contentOfBag;
using test::kSession;

/// Returns all parameters in force as a node writes them: the shipped ones overridden by these.
std::string yamlWith(const std::string& parameters = "level: rocker\n", const InputTopics& topics = {}) {
  const test::TemporaryFile file(parameters);
  return withInputTopics(*loadFiles(configDirectory(), {file.path()}).value, topics).yaml;
}

RunInfo runInfo(const std::string& yaml, const ros::Time& stamp) {
  RunInfo info;
  info.header.stamp = stamp;
  info.version = "0.1.0";
  info.revision = "f00d";
  info.parameters_yaml = yaml;
  return info;
}

const ros::Time kStart(1700000000.0), kMiddle(1700000015.0), kEnd(1700000100.0);

class RecordedRuns : public test::BagFiles {
 protected:
  /// Writes the session's messages of [from, to) under other names, after those that `more` writes.
  std::string writeLog(const std::string& name, const std::function<void(rosbag::Bag&)>& more,
                       const ros::Time& from = kStart, const ros::Time& to = kEnd,
                       const InputTopics& topics = {"/hammer/crank", "/joint_states", ""}) const {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    more(bag);
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      if (item.getTime() < from || item.getTime() >= to) return;
      bag.write(item.getTopic() == "/hammer/crank" ? topics.crank : topics.joint_states, item.getTime(), item);
    });
    return path(name);
  }
  std::string plain(const std::string& name, const ros::Time& from = kStart, const ros::Time& to = kEnd) const {
    return writeLog(
        name, [](rosbag::Bag&) {}, from, to);
  }
  static std::string run_info(rosbag::Bag& bag, const std::string& yaml, const ros::Time& time,
                              const std::string& node = "/hammer_loads") {
    bag.write(node + "/run_info", time, runInfo(yaml, time));
    return yaml;
  }
  /// Returns the output of process_bag with these parameters and no run_info.
  std::vector<std::string> reference(const std::string& in, const std::string& yaml) const {
    const test::TemporaryFile file(yaml);
    const std::string out = path("reference_" + std::to_string(names().size()) + ".bag");
    EXPECT_EQ(run(in + " " + out + " --params " + file.path()).exit_code, 0);
    return contentOfBag(out);
  }
  static void expectSaid(const test::Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
};

TEST_F(RecordedRuns, SplitsOfOneRecordingFindEachOther) {
  const std::string yaml = yamlWith();
  const ros::Time quarter(1700000007.0);
  // Each split repeats the run_info in force, with the instant when the run began.
  const auto repeats = [&](const ros::Time& began, const ros::Time& time, const std::string& text) {
    return [=](rosbag::Bag& bag) { bag.write("/hammer_loads/run_info", time, runInfo(text, began)); };
  };
  const std::string late = writeLog("late.bag", repeats(kStart, kMiddle, yaml), kMiddle, kEnd);
  const std::string early = writeLog("early.bag", repeats(kStart, kStart, yaml), kStart, quarter);
  const std::string other = writeLog("other.bag", repeats(quarter, quarter, yaml), quarter, kEnd);  // a restarted node
  const std::string middle = writeLog("m i d.bag", repeats(kStart, quarter, yaml), quarter, kMiddle);
  const std::string bare = plain("bare.bag");
  const test::TemporaryFile broken("no bag");
  const test::Outcome outcome =
      run("--recordings " + late + " " + broken.path() + " " + early + " " + other + " '" + middle + "' " + bare);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(test::linesOf(outcome.out), (std::vector<std::string>{"0 " + early, "0 " + middle, "0 " + late,
                                                                  "1 " + broken.path(), "2 " + other, "3 " + bare}));
}

TEST_F(RecordedRuns, ParametersAndTopicsAreThoseOfTheLog) {
  const std::string changed = "level: linkage\ngravity_m_s2: 3.7\n";
  const InputTopics topics{"/machine/turns", "/machine/joints", "/machine/imu"};
  const std::string log = writeLog(
      "log.bag", [&](rosbag::Bag& bag) { run_info(bag, yamlWith(changed, topics), kStart); }, kStart, kEnd, topics);
  const test::Outcome outcome = run(log + " " + path("out.bag"));
  expectSaid(outcome, {"parameters of /hammer_loads/run_info", "0.1.0", "f00d", "--params"});
  EXPECT_EQ(outcome.err.find("MO-100"), std::string::npos) << "the hammer is known: " << outcome.err;
  const std::vector<std::string> again = contentOfBag(path("out.bag"));
  EXPECT_GT(again.size(), 8000U);
  EXPECT_TRUE(again == reference(plain("plain.bag"), changed));
  EXPECT_FALSE(again == reference(path("plain.bag"), "level: rocker\n")) << "the parameters count";

  // Given parameters override the log's. The log still determines the input topics.
  const test::TemporaryFile other("level: rocker\n");
  const test::Outcome given = run(log + " " + path("given.bag") + " --params " + other.path());
  ASSERT_EQ(given.exit_code, 0) << given.err;
  EXPECT_EQ(given.err.find("parameters of"), std::string::npos) << given.err;
  EXPECT_TRUE(contentOfBag(path("given.bag")) == reference(path("plain.bag"), "level: rocker\n"));
  // Given topic names override both.
  const test::TemporaryFile named("level: rocker\ninput_topic_crank: /nowhere\n");
  expectRefused(run(log + " " + path("x.bag") + " --params " + named.path()), {"no topic /nowhere"});
  expectRefused(run(log + " " + path("x.bag") + " --crank-topic /hammer/crank"), {"no topic /hammer/crank"});
}

TEST_F(RecordedRuns, TheOutputsRunInfoNamesTheTopics) {
  const std::string log = plain("in.bag");
  ASSERT_EQ(run(log + " " + path("out.bag")).exit_code, 0);
  rosbag::Bag bag(path("out.bag"));
  rosbag::View view(bag, rosbag::TopicQuery("/hammer_loads/run_info"));
  ASSERT_EQ(view.size(), 1U);
  const std::string yaml = view.begin()->instantiate<RunInfo>()->parameters_yaml;
  for (const char* line : {"input_topic_crank: \"/hammer/crank\"\n", "input_topic_joint_states: \"/joint_states\"\n"})
    EXPECT_NE(yaml.find(line), std::string::npos) << yaml;
}

/// The reference is the two halves processed as two recordings.
TEST_F(RecordedRuns, EachRunInfoAppliesFromItsRecordTime) {
  const std::string first = yamlWith("level: linkage\n"), second = yamlWith("gravity_m_s2: 1.6\n");
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    run_info(bag, first, kStart);
    run_info(bag, second, kMiddle);
  });
  const test::Outcome outcome = run(log + " " + path("out.bag"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("2 runs"), std::string::npos) << outcome.out;
  std::vector<std::string> halves = reference(plain("a.bag", kStart, kMiddle), first);
  const std::vector<std::string> rest = reference(plain("b.bag", kMiddle, kEnd), second);
  halves.insert(halves.end(), rest.begin(), rest.end());
  std::sort(halves.begin(), halves.end());
  EXPECT_TRUE(contentOfBag(path("out.bag")) == halves);
}

/// A log that was split for its size repeats the run_info in force.
TEST_F(RecordedRuns, ARepeatedRunInfoBeginsNoRun) {
  const std::string yaml = yamlWith("level: linkage\n");
  const auto repeated = [&](const ros::Time& time) {
    return [&yaml, time](rosbag::Bag& bag) { bag.write("/hammer_loads/run_info", time, runInfo(yaml, kStart)); };
  };
  const std::string log =
      writeLog("a.bag", repeated(kStart), kStart, kMiddle) + " " + writeLog("b.bag", repeated(kMiddle), kMiddle, kEnd);
  const test::Outcome outcome = run(log + " " + path("out.bag"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contentOfBag(path("out.bag")) == reference(plain("plain.bag"), yaml));
}

/// The recording began while the node ran already: its latched run_info comes some time after the first inputs.
TEST_F(RecordedRuns, ALateRunInfoAppliesToWhatCameBeforeItAsWell) {
  const std::string yaml = yamlWith("level: linkage\n");
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    bag.write("/hammer_loads/run_info", kStart + ros::Duration(0.3), runInfo(yaml, kStart - ros::Duration(60.0)));
  });
  ASSERT_EQ(run(log + " " + path("out.bag")).exit_code, 0);
  EXPECT_TRUE(contentOfBag(path("out.bag")) == reference(plain("plain.bag"), yaml));
}

TEST_F(RecordedRuns, KeysOfAnotherVersionAreNamed) {
  std::string yaml = yamlWith("level: linkage\n") + "stiffness_of_yesterday: 3.0\n";
  const std::size_t begin = yaml.find("stale_after_s:");
  yaml.erase(begin, yaml.find('\n', begin) + 1 - begin);
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) { run_info(bag, yaml, kStart); });
  expectSaid(run(log + " " + path("out.bag")),
             {"stiffness_of_yesterday: 3.0, not known to this version", "stale_after_s: not recorded", "0.25"});
  EXPECT_TRUE(contentOfBag(path("out.bag")) == reference(plain("plain.bag"), "level: linkage\n"));
}

TEST_F(RecordedRuns, ParametersThatCannotBeUsedAreExit1) {
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) { run_info(bag, "rocker_mass_kg: -1\n", kStart); });
  const test::Outcome outcome = run(log + " " + path("out.bag"));
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* word : {"/hammer_loads/run_info: rocker_mass_kg: -1", "--params"})
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  EXPECT_EQ(names(), (std::vector<std::string>{"log.bag"}));
}

TEST_F(RecordedRuns, TwoHammersInOneBagNeedParams) {
  const std::string yaml = yamlWith("level: linkage\n");
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    run_info(bag, yaml, kStart, "/left");
    run_info(bag, yamlWith(), kStart, "/right");
  });
  expectRefused(run(log + " " + path("out.bag")), {"/left/run_info, /right/run_info", "--params"});
  EXPECT_EQ(names(), (std::vector<std::string>{"log.bag"}));
  EXPECT_TRUE(reference(log, yaml) == reference(plain("plain.bag"), yaml));
}

TEST_F(RecordedRuns, AGrapplesRunInfoIsNotTheHammers) {
  const std::string yaml = yamlWith("level: linkage\n");
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    run_info(bag, "slider_joint: grapple_slider_joint\nbd_length_m: 1.0\n", kStart, "/grapple");
    run_info(bag, yaml, kStart);
  });
  expectSaid(run(log + " " + path("out.bag")), {"parameters of /hammer_loads/run_info"});
  EXPECT_TRUE(contentOfBag(path("out.bag")) == reference(plain("plain.bag"), yaml));
}

TEST_F(RecordedRuns, TheRobotDescriptionIsThatOfTheLogUnlessOneIsGiven) {
  const std::string urdf = test::sourceFile("urdf/eo2621_mo100.urdf");
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    RunInfo info = runInfo(yamlWith(), kStart);
    info.robot_description = test::contentOf(urdf);
    bag.write("/hammer_loads/run_info", kStart, info);
  });
  const auto count = [&](const std::string& bag_file) {
    rosbag::Bag bag(bag_file);
    return rosbag::View(bag, rosbag::TopicQuery("/hammer_loads/joint_loads")).size();
  };
  ASSERT_EQ(run(log + " " + path("out.bag")).exit_code, 0);
  EXPECT_GT(count(path("out.bag")), 2900U);
  const test::TemporaryFile parameters("level: linkage\n");
  expectSaid(run(log + " " + path("params.bag") + " --params " + parameters.path()),
             {"robot_description of /hammer_loads/run_info", "--urdf"});
  EXPECT_GT(count(path("params.bag")), 2900U);
  const test::TemporaryFile other("<robot name='no boom'><link name='base'/></robot>", ".urdf");
  const test::Outcome given = run(log + " " + path("urdf.bag") + " --urdf " + other.path());
  EXPECT_TRUE(given.exit_code == 1 || count(path("urdf.bag")) == 0U) << "the given one counts";
}

TEST_F(RecordedRuns, ARunInfoOfAnotherDefinitionIsNamed) {
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    topic_tools::ShapeShifter old;
    old.morph("0123456789abcdef0123456789abcdef", "hammer_loads/RunInfo", "string parameters\n", "1");
    std::vector<std::uint8_t> bytes(4, 0);
    ros::serialization::IStream stream(bytes.data(), 4);
    old.read(stream);
    bag.write("/hammer_loads/run_info", kStart, old);
  });
  expectSaid(run(log + " " + path("out.bag")),
             {"warning: /hammer_loads/run_info: hammer_loads/RunInfo of another definition", "0123456789abcdef"});
}

TEST_F(RecordedRuns, ReadsTheImuFromTheLogsTopicAndReportsItsAbsence) {
  const std::string measured = yamlWith("hull_motion: imu\n", {"", "", "/hull_imu"});
  const auto imu = [](rosbag::Bag& bag) {
    sensor_msgs::Imu m;
    m.linear_acceleration.z = 9.80665;
    for (int i = 0; i < 6000; ++i) {
      m.header.stamp = kStart + ros::Duration(0.005 * i);
      bag.write("/hull_imu", m.header.stamp, m);
    }
  };
  const std::string log = writeLog("log.bag", [&](rosbag::Bag& bag) {
    run_info(bag, measured, kStart);
    imu(bag);
  });
  const test::Outcome heard = run(log + " " + path("heard.bag"));
  ASSERT_EQ(heard.exit_code, 0) << heard.err;
  EXPECT_EQ(heard.err.find("warning"), std::string::npos) << heard.err;
  std::size_t flagged = 0;
  {
    rosbag::Bag bag(path("heard.bag"));
    for (const rosbag::MessageInstance& item : rosbag::View(bag, rosbag::TopicQuery("/hammer_loads/hull_loads")))
      flagged += (item.instantiate<HullLoads>()->flags & HullLoads::FLAG_HULL_MOTION) != 0 ? 1 : 0;
  }
  EXPECT_GT(flagged, 2900U);
  // Without its topic name the IMU is looked for on the default topic, and this is reported.
  const std::string nameless = writeLog("nameless.bag", [&](rosbag::Bag& bag) {
    run_info(bag, yamlWith("hull_motion: imu\n"), kStart);
    imu(bag);
  });
  expectSaid(run(nameless + " " + path("missed.bag")),
             {"warning: hull_motion: imu, but no message on /hammer/hull_imu (--imu-topic)", "there: /hull_imu\n"});
}

}  // namespace
}  // namespace hammer_loads
