// The command calibrate: files, errors and exit codes.
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <regex>

#include "commands/bag_files.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::Outcome;
using test::TemporaryFile;

class Calibrate : public test::BagFiles {
 protected:
  Calibrate() : output_(path("found.yaml")) {}
  const std::string output_;
};

Outcome runCalibrate(const std::string& arguments) { return test::runCommand(HAMMER_LOADS_CALIBRATE, arguments); }

TEST_F(Calibrate, WritesParametersThatEveryOtherCommandReads) {
  const Outcome outcome = runCalibrate(test::kSession + " --write " + output_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("found: crank_zero_rad"), std::string::npos);
  EXPECT_LE(test::linesOf(outcome.out).size(), 8U) << outcome.out;
  const Checked<Settings> settings = loadFiles(configDirectory(), {output_});
  ASSERT_TRUE(settings.value) << settings.problems.front();
  // The recording's encoder has no zero offset and 4096 counts. The drive inertia is 0.6 kg m2.
  EXPECT_NEAR(settings.value->pipeline.crank_sensor.reading(0.0), 0.0, 0.006);
  EXPECT_NEAR(settings.value->pipeline.crank_angle_resolution, kTwoPi / 4096, 1e-9);
  EXPECT_NEAR(settings.value->mechanism.parameters().drive_inertia, 0.6, 0.05);
  EXPECT_NE(contentOf(path("found.svg")).find("</svg>"), std::string::npos);

  const std::string before = contentOf(output_);
  const Outcome again = runCalibrate(test::kSession + " --write " + output_);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("--force"), std::string::npos);
  EXPECT_EQ(contentOf(output_), before);
  EXPECT_EQ(runCalibrate(test::kSession + " --force --write " + output_).exit_code, 0);
  EXPECT_EQ(contentOf(output_), before);  // the same input gives the same bytes
}

TEST_F(Calibrate, ReplacesNothingThatItDidNotWrite) {
  const TemporaryFile others("crank_zero_rad: 0.1\n");
  const Outcome outcome = runCalibrate(test::kSession + " --force --write " + others.path());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("no calibration"), std::string::npos) << outcome.err;
  EXPECT_EQ(contentOf(others.path()), "crank_zero_rad: 0.1\n");
}

TEST_F(Calibrate, RefusesWhatItCannotUse) {
  const Outcome no_topic = runCalibrate(test::kSession + " --crank-topic /other --write " + output_);
  EXPECT_EQ(no_topic.exit_code, 1);
  EXPECT_NE(no_topic.err.find("/other"), std::string::npos);
  const TemporaryFile text("not a bag");
  EXPECT_EQ(runCalibrate(text.path() + " --write " + output_).exit_code, 1);
  EXPECT_EQ(runCalibrate(test::kSession + " --force --write " + test::kSession).exit_code, 1);
  const TemporaryFile wrong("crank_direction: 2\n");
  EXPECT_EQ(runCalibrate(test::kSession + " --params " + wrong.path() + " --write " + output_).exit_code, 1);
  EXPECT_FALSE(fs::exists(output_));
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(runCalibrate(pipe + " --write " + output_).err, pipe + ": is no regular file, must be a bag\n");
  for (const std::string& usage : {test::kSession, std::string("--write x"), test::kSession + " --write x --nonsense"})
    EXPECT_EQ(runCalibrate(usage).exit_code, 2) << usage;
  EXPECT_EQ(runCalibrate("--help").exit_code, 0);
}

/// Returns an exact hammer file, so that only too few blows leave a key undetermined.
std::string exactHammer() {
  std::string yaml;
  for (const HammerConstant& constant : kHammerConstants)
    if (constant.enters != HammerConstant::Enters::kLearned && constant.enters != HammerConstant::Enters::kFollows)
      yaml += deviationKey(constant) + ": 0\n";
  return yaml;
}

/// Records a machine at work on a topic of its own; the encoder is 0.4 deg off and has 1024 counts. The first reading
/// is recorded before the first message of /clock, at 1 ns.
void recordWork(const std::string& path, double seconds, double rate, const std::string& topic) {
  simulation::MachineSettings machine = simulation::workingMo100();
  machine.duration = seconds;
  machine.drive.stop_time = seconds + 10.0;
  machine.crank.rate = rate;
  machine.crank.zero = 0.4 * kDegree;
  machine.crank.counts = 1024;
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setChunkThreshold(100000);  // [byte], a few seconds
  RunInfo info;
  info.header.stamp.fromNSec(static_cast<std::uint64_t>(machine.start_stamp));
  const TemporaryFile exact(exactHammer(), ".yaml");
  info.parameters_yaml =
      loadFiles(configDirectory(), {exact.path()}).value.value().yaml + "input_topic_crank: \"" + topic + "\"\n";
  bag.write("/hammer_loads/run_info", info.header.stamp, info);
  sensor_msgs::JointState message;
  message.name = {"hammer_crank_joint"};
  ros::Time record(0, 1);
  for (const simulation::CrankReading& reading : simulation::recordSession(machine).crank) {
    message.header.stamp.fromNSec(static_cast<std::uint64_t>(reading.stamp));
    message.position = {reading.angle};
    message.velocity.clear();
    if (reading.speed) message.velocity = {*reading.speed};
    bag.write(topic, record, message);
    record = message.header.stamp;
  }
}

/// Returns each key's printed standard deviation and limit.
std::map<std::string, std::pair<double, double>> deviationsIn(const std::string& out) {
  std::map<std::string, std::pair<double, double>> found;
  const std::regex line(R"((\w+) +\S+.* \+- (\S+), limit ([0-9.e+-]+))");
  std::smatch parts;
  for (const std::string& text : test::linesOf(out))
    if (std::regex_search(text, parts, line)) found[parts[1]] = {std::stod(parts[2]), std::stod(parts[3])};
  return found;
}

TEST_F(Calibrate, ReadsNoMoreOfALongRecordingThanItNeeds) {
  const std::string bag = path("work.bag");
  recordWork(bag, 300.0, 100.0, "/drive/encoder");  // topic and parameters come from its run_info
  const Outcome outcome = runCalibrate(bag + " --verbose --write " + output_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("parameters of /hammer_loads/run_info are used"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\r'), std::string::npos);  // no progress bar without a terminal
  const double seconds = std::stod(outcome.out);
  EXPECT_GT(seconds, 100.0);
  EXPECT_LT(seconds, 250.0);
  const auto deviations = deviationsIn(outcome.out);
  ASSERT_EQ(deviations.count("crank_zero_rad"), 1U) << outcome.out;
  for (const auto& [key, known] : deviations) {
    if (key != "drive_inertia_kg_m2") {
      EXPECT_LE(known.first, 0.5 * known.second) << key;
    }
  }
  const Checked<Settings> settings = loadFiles(configDirectory(), {output_});
  ASSERT_TRUE(settings.value);
  EXPECT_NEAR(settings.value->pipeline.crank_sensor.reading(0.0), 0.4 * kDegree,
              3.0 * deviations.at("crank_zero_rad").first);
}

TEST_F(Calibrate, ShowsTheTimeLeftOnATerminal) {
  if (test::runCommand("script", "-qec true /dev/null").exit_code != 0) GTEST_SKIP() << "no terminal can be made here";
  const Outcome outcome = test::runCommand(
      "script", "-qec '" HAMMER_LOADS_CALIBRATE " " + test::kSession + " --write " + output_ + "' /dev/null");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_TRUE(std::regex_search(outcome.out, std::regex(R"(\r\[#+ +\] +\d+ %  \d+:\d\d left)"))) << outcome.out;
  EXPECT_NE(outcome.out.find(" 100 %"), std::string::npos);
}

TEST_F(Calibrate, ADamagedBagIsOneLine) {
  const std::string bag = path("work.bag");
  recordWork(bag, 30.0, 100.0, "/drive/encoder");
  std::string bytes = contentOf(bag);
  const std::size_t at = bytes.find("crank_joint");  // within the chunk that holds the run_info
  ASSERT_NE(at, std::string::npos);
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at) + 60000,
            '\xff');
  std::ofstream(bag, std::ios::binary) << bytes;
  const Outcome outcome = runCalibrate(bag + " --write " + output_);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(test::linesOf(outcome.err).size(), 1U) << outcome.err;
  EXPECT_EQ(outcome.err.rfind(bag + ": cannot be read", 0), 0U) << outcome.err;
}

}  // namespace
}  // namespace hammer_loads
