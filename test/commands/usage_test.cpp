/// --help and --version of every program, without a ROS master.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/command.h"

namespace hammer_loads {
namespace {

const std::vector<std::string> kCommands{
    HAMMER_LOADS_ACCURACY,      HAMMER_LOADS_COUNT_CYCLES, HAMMER_LOADS_EVALUATE,        HAMMER_LOADS_LIFE,
    HAMMER_LOADS_GRAPPLE_TABLE, HAMMER_LOADS_PROCESS_BAG,  HAMMER_LOADS_PROCESS_GRAPPLE, HAMMER_LOADS_TURN_TABLE};
const std::vector<std::string> kNodes{HAMMER_LOADS_HAMMER_LOADS_NODE, HAMMER_LOADS_GRAPPLE_NODE,
                                      HAMMER_LOADS_SIMULATE_HAMMER, HAMMER_LOADS_SIMULATE_GRAPPLE};

std::vector<std::string> programs() {
  std::vector<std::string> all = kCommands;
  all.insert(all.end(), kNodes.begin(), kNodes.end());
  all.push_back(HAMMER_LOADS_SHOW_LOADS);  // a node without a parameter file
  return all;
}

TEST(Usage, IsPrintedOnRequestAndNothingElseIsDone) {
  for (const std::string& program : programs()) {
    for (const char* option : {" --help", " -h"}) {
      const test::Outcome outcome = test::runCommand("ROS_MASTER_URI=http://localhost:1 " + program, option);
      EXPECT_EQ(outcome.exit_code, 0) << program;
      EXPECT_EQ(outcome.err, "") << program;
      const std::string name = std::filesystem::path(program).filename();
      for (const std::string& word : {name, std::string("Usage: "), std::string("--help"), std::string("--version")})
        EXPECT_NE(outcome.out.find(word), std::string::npos) << program << option << ": " << word << outcome.out;
      for (const std::string& line : test::linesOf(outcome.out)) EXPECT_LE(line.size(), 140U) << line;
    }
  }
}

TEST(Usage, AnUnknownOptionIsOneLineAndExitCode2) {
  for (const std::string& program : kCommands) {
    const test::Outcome outcome = test::runCommand(program, "--no-such-option");
    EXPECT_EQ(outcome.exit_code, 2) << program;
    EXPECT_EQ(outcome.out, "") << program;
    EXPECT_EQ(test::linesOf(outcome.err).size(), 1U) << outcome.err;
  }
}

TEST(Usage, OutputThatCannotBeWrittenIsAnError) {
  const test::TemporaryFile states(
      "crank_angle_rad,crank_speed_rad_s,crank_accel_rad_s2,hull_pitch_rad,gravity_m_s2\n1,2,3,4,5\n", ".csv");
  for (const char* program : {HAMMER_LOADS_TURN_TABLE, HAMMER_LOADS_EVALUATE}) {
    const test::TemporaryFile err({}, ".err");
    const std::string command = std::string(program) + " <" + states.path() + " >/dev/full 2>" + err.path();
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1) << program;
    EXPECT_EQ(test::contentOf(err.path()), "stdout: cannot be written\n") << program;
  }
}

/// The ledger's library and SQLite with it are loaded only when a ledger is requested (ros/ledger.test).
TEST(HammerLoadsNode, LinksNeitherGrappleNorSqliteNorOpenssl) {
  const test::Outcome linked = test::runCommand("ldd", HAMMER_LOADS_HAMMER_LOADS_NODE);
  ASSERT_NE(linked.out.find("libhammer_loads_pipeline.so"), std::string::npos) << linked.out;
  for (const char* library : {"grapple", "libsqlite3", "libcrypto", "libssl", "hammer_loads_ledger", "not found"})
    EXPECT_EQ(linked.out.find(library), std::string::npos) << linked.out;
}

TEST(Usage, VersionIsThatOfThePackage) {
  const std::string package = test::contentOf(std::string(HAMMER_LOADS_TEST_DATA) + "/../../package.xml");
  const std::size_t begin = package.find("<version>") + 9;
  const std::string version = package.substr(begin, package.find('<', begin) - begin);
  for (const std::string& program : programs()) {
    const test::Outcome outcome = test::runCommand("ROS_MASTER_URI=http://localhost:1 " + program, "--version");
    EXPECT_EQ(outcome.exit_code, 0) << program;
    EXPECT_EQ(outcome.out, "hammer_loads " + version + "\n") << program;
    EXPECT_EQ(outcome.err, "") << program;
  }
}

/// The parameter files that a node's usage names are shipped.
TEST(Usage, NamesParameterFilesThatExist) {
  const std::string config = std::string(HAMMER_LOADS_TEST_DATA) + "/../../config/";
  for (const std::string& program : kNodes) {
    const std::string usage = test::runCommand(program, "--help").out;
    std::size_t files = 0;
    for (std::size_t end = usage.find(".yaml"); end != std::string::npos; end = usage.find(".yaml", end + 1), ++files) {
      const std::size_t begin = usage.find_last_of(" /", end) + 1;
      EXPECT_TRUE(std::filesystem::exists(config + usage.substr(begin, end + 5 - begin))) << usage.substr(begin, 30);
    }
    EXPECT_GE(files, 1U) << program;
  }
}

}  // namespace
}  // namespace hammer_loads
