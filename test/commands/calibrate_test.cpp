// The command calibrate as its user meets it: files, errors and exit codes.
#include <filesystem>

#include "hammer_loads/linkage/crank_angle.h"
#include "hammer_loads/settings/load.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::Outcome;
using test::TemporaryFile;

const std::string kBag = std::string(HAMMER_LOADS_TEST_DATA) + "/mo100_100hz.bag";

Outcome runCalibrate(const std::string& arguments) { return test::runCommand(HAMMER_LOADS_CALIBRATE, arguments); }

/// A name that is free, and nothing left of it afterwards.
class FreeName {
 public:
  FreeName() : name_(TemporaryFile("").path() + ".yaml") {}
  FreeName(const FreeName&) = delete;
  FreeName& operator=(const FreeName&) = delete;
  ~FreeName() {
    std::error_code error;
    fs::remove(name_, error);
    fs::remove(picture(), error);
  }
  const std::string& path() const { return name_; }
  std::string picture() const { return fs::path(name_).replace_extension(".svg").string(); }

 private:
  std::string name_;
};

TEST(Calibrate, WritesParametersThatEveryOtherCommandReads) {
  const FreeName output;
  const Outcome outcome = runCalibrate(kBag + " --write " + output.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("crank_zero_rad"), std::string::npos);
  const Checked<Settings> settings = loadFiles(configDirectory(), {output.path()});
  ASSERT_TRUE(settings.value) << settings.problems.front();
  // The recording's encoder sits where it should: 4096 counts, drive inertia 0.6.
  EXPECT_NEAR(settings.value->pipeline.crank_sensor.reading(0.0), 0.0, 0.006);
  EXPECT_NEAR(settings.value->pipeline.crank_angle_resolution, kTwoPi / 4096, 1e-9);
  EXPECT_NEAR(settings.value->mechanism.parameters().drive_inertia, 0.6, 0.05);
  EXPECT_NE(contentOf(output.picture()).find("</svg>"), std::string::npos);

  const std::string before = contentOf(output.path());
  const Outcome again = runCalibrate(kBag + " --write " + output.path());
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("--force"), std::string::npos);
  EXPECT_EQ(contentOf(output.path()), before);
  EXPECT_EQ(runCalibrate(kBag + " --force --write " + output.path()).exit_code, 0);
  EXPECT_EQ(contentOf(output.path()), before);  // the same input gives the same bytes
}

TEST(Calibrate, ReplacesNothingThatItDidNotWrite) {
  const TemporaryFile others("crank_zero_rad: 0.1\n");
  const Outcome outcome = runCalibrate(kBag + " --force --write " + others.path());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("no calibration"), std::string::npos) << outcome.err;
  EXPECT_EQ(contentOf(others.path()), "crank_zero_rad: 0.1\n");
}

TEST(Calibrate, RefusesWhatItCannotUse) {
  const FreeName output;
  const TemporaryFile flexible("shaft: flexible\n");
  const Outcome coupling = runCalibrate(kBag + " --params " + flexible.path() + " --write " + output.path());
  EXPECT_EQ(coupling.exit_code, 1);
  EXPECT_EQ(coupling.err, "shaft: flexible, must be rigid for calibrate\n");
  EXPECT_FALSE(fs::exists(output.path()));
  const Outcome no_topic = runCalibrate(kBag + " --crank-topic /other --write " + output.path());
  EXPECT_EQ(no_topic.exit_code, 1);
  EXPECT_NE(no_topic.err.find("/other"), std::string::npos);
  const TemporaryFile text("not a bag");
  EXPECT_EQ(runCalibrate(text.path() + " --write " + output.path()).exit_code, 1);
  EXPECT_EQ(runCalibrate(kBag + " --force --write " + kBag).exit_code, 1);
  const TemporaryFile wrong("crank_direction: 2\n");
  EXPECT_EQ(runCalibrate(kBag + " --params " + wrong.path() + " --write " + output.path()).exit_code, 1);
  EXPECT_FALSE(fs::exists(output.path()));
}

TEST(Calibrate, WrongUsageAndHelp) {
  EXPECT_EQ(runCalibrate(kBag).exit_code, 2);
  EXPECT_EQ(runCalibrate("--write x.yaml").exit_code, 2);
  EXPECT_EQ(runCalibrate(kBag + " --write x.yaml --nonsense").exit_code, 2);
  EXPECT_EQ(runCalibrate("--help").exit_code, 0);
}

}  // namespace
}  // namespace hammer_loads
