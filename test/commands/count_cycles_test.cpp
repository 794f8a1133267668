// count_cycles as its user runs it.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <random>

#include "settings/temporary_file.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

using test::contentOf;
using test::linesOf;
using test::Outcome;
using test::TemporaryFile;
namespace fs = std::filesystem;

Outcome runCountCycles(const std::string& arguments, const std::string& input) {
  return test::runCommand(HAMMER_LOADS_COUNT_CYCLES, arguments, input);
}

const std::string kFigure6 = "-2\n1\n-3\n5\n-1\n3\n-4\n4\n-2\n";
const std::string kCount =
    "range,mean,count\n3,-0.5,0.5\n4,-1,0.5\n4,1,1\n6,1,0.5\n8,0,0.5\n8,1,0.5\n9,0.5,0.5\n";  // ASTM E1049-85, Fig. 6

/// In a directory of its own, removed with it.
class State {
 public:
  State() : directory_(testing::TempDir() + "count_cycles_" + std::to_string(getpid())) {
    fs::remove_all(directory_);
    fs::create_directory(directory_);
  }
  ~State() { fs::remove_all(directory_); }
  std::string path() const { return (directory_ / "state").string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }

 private:
  fs::path directory_;
};

TEST(CountCycles, PrintsTheStandardsCount) {
  for (const char* arguments : {"", "--exact", "--full-scale -10.5 10.5 --classes 21"}) {
    const Outcome outcome = runCountCycles(arguments, kFigure6);
    EXPECT_EQ(outcome.out, kCount) << arguments;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.exit_code, 0);
  }
}

TEST(CountCycles, ReadsWhatRecordersWrite) {
  EXPECT_EQ(runCountCycles("", " -2.0\r\n+1e0\n\n-3\n5\n nan\n-1\n3\n-inf\n-4\nNaN\n4.\n-2").out, kCount);
  EXPECT_EQ(runCountCycles("", "1\nnan\n2\n").err, "warning: stdin: 1 skipped, not a finite load\n");
}

TEST(CountCycles, ASeriesWithoutACycleGivesTheHeader) {
  for (const char* series : {"", "\n", "7\n", "7\n7\n7\n", "nan\n"}) {
    const Outcome outcome = runCountCycles("", series);
    EXPECT_EQ(outcome.out, "range,mean,count\n");
    EXPECT_EQ(outcome.exit_code, 0);
  }
  EXPECT_EQ(runCountCycles("", "").err, "warning: stdin: no number to count\n");
}

TEST(CountCycles, SaturationIsReported) {
  const Outcome outcome = runCountCycles("--full-scale 0 10 --classes 10", "-1\n12\n5\n11\n");
  EXPECT_EQ(outcome.err, "warning: stdin: 1 below and 2 above the full scale, counted at its ends\n");
  EXPECT_EQ(outcome.exit_code, 0);
}

TEST(CountCycles, PiecesWithAStateGiveTheCountOfTheWhole) {
  std::mt19937 random(1);
  std::normal_distribution<double> value(0.0, 3.0);
  for (const std::string arguments : {"--exact", "--full-scale -8 9 --classes 300"}) {
    const State state;
    std::string whole, last;
    for (int piece = 0; piece < 6; ++piece) {
      std::string series;
      for (int i = 0; i < piece * 40; ++i) series += std::to_string(value(random)) + "\n";
      whole += series;
      const Outcome outcome =
          runCountCycles(piece < 3 ? arguments + " --state " + state.path() : "--state " + state.path(), series);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      last = outcome.out;
    }
    EXPECT_EQ(last, runCountCycles(arguments, whole).out);
    EXPECT_EQ(state.files(), 1U);
  }
}

TEST(CountCycles, AFailedRunLeavesTheStateAsItWas) {
  const State state;
  ASSERT_EQ(runCountCycles("--state " + state.path(), "1\n5\n2\n").exit_code, 0);
  const std::string before = contentOf(state.path());
  EXPECT_EQ(runCountCycles("--state " + state.path(), "3\nfive\n").exit_code, 1);
  EXPECT_EQ(contentOf(state.path()), before);
  const TemporaryFile in("4\n", ".in");
  const std::string command = std::string(HAMMER_LOADS_COUNT_CYCLES) + " --state " + state.path() + " <" + in.path() +
                              " >/dev/full 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_EQ(contentOf(state.path()), before);
  EXPECT_EQ(state.files(), 1U);
}

/// Each waits for those before it: a row of equal swings has as many half cycles as swings, whatever the order.
TEST(CountCycles, RunsAtOnceOnOneStateLoseNothing) {
  constexpr int kRuns = 16;
  const State state;
  ASSERT_EQ(runCountCycles("--exact --state " + state.path(), "0\n8\n0\n").exit_code, 0);
  std::string script;
  for (int i = 0; i < kRuns; ++i)
    script += "printf '8\\n0\\n' | " + std::string(HAMMER_LOADS_COUNT_CYCLES) + " --state " + state.path() +
              " > /dev/null || echo failed &\n";
  const TemporaryFile all(script + "wait\n", ".sh");
  EXPECT_EQ(test::runCommand("sh", all.path()).out, "");
  EXPECT_EQ(runCountCycles("--state " + state.path(), "").out,
            "range,mean,count\n8,4," + std::to_string(kRuns + 1) + "\n");
}

TEST(CountCycles, AnythingElseInTheStatesPlaceIsRefused) {
  const State state;
  ASSERT_EQ(runCountCycles("--full-scale 0 10 --classes 10 --state " + state.path(), "1\n5\n2\n").exit_code, 0);
  const std::string good = contentOf(state.path());
  const std::string other = testing::TempDir() + "count_cycles_other";
  for (const std::string& content :
       {std::string{}, std::string("my notes\n"), good.substr(0, good.size() - 3), good + "more\n"}) {
    std::ofstream(other, std::ios::binary) << content;
    const Outcome outcome = runCountCycles("--state " + other, "1\n2\n");
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(other), std::string::npos);
    EXPECT_EQ(contentOf(other), content);
  }
  std::remove(other.c_str());
  for (const std::string& place : {testing::TempDir(), std::string("/dev/null"), std::string("/no/such/place/state")}) {
    const Outcome outcome = runCountCycles("--state " + place, "1\n2\n");
    EXPECT_EQ(outcome.exit_code, 1) << place;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  }
  for (const char* kind : {"--exact", "--full-scale 0 11", "--full-scale 0 10 --classes 11"}) {
    const Outcome outcome = runCountCycles(std::string(kind) + " --state " + state.path(), "1\n2\n");
    EXPECT_EQ(outcome.exit_code, 1) << kind;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  }
  EXPECT_EQ(contentOf(state.path()), good);
}

TEST(CountCycles, ALinkStaysALinkAndPermissionsStay) {
  const State state;
  const std::string link = testing::TempDir() + "count_cycles_link";
  fs::remove(link);
  ASSERT_EQ(runCountCycles("--state " + state.path(), "1\n").exit_code, 0);
  ASSERT_EQ(chmod(state.path().c_str(), 0640), 0);
  fs::create_symlink(state.path(), link);
  EXPECT_EQ(runCountCycles("--state " + link, "5\n").out, "range,mean,count\n4,3,0.5\n");
  EXPECT_TRUE(fs::is_symlink(link));
  struct stat status {};
  ASSERT_EQ(stat(state.path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
  fs::remove(link);
}

TEST(CountCycles, BadLinesAreOneLineAndExitCode1) {
  for (const char* bad : {"five", "1,2", "0x10", "1e999", "1 2", "--", "nan(1)", "\x01"}) {
    const Outcome outcome = runCountCycles("", std::string("1\n") + bad + "\n3\n");
    EXPECT_EQ(outcome.exit_code, 1) << bad;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("stdin: line 2: ", 0), 0U) << outcome.err;
  }
}

TEST(CountCycles, WrongUsageIsOneLineAndExitCode2) {
  for (const char* arguments :
       {"--classes 10", "--full-scale 1", "--full-scale 1 1", "--full-scale 2 1", "--full-scale 0 nan",
        "--exact --full-scale 0 1", "--full-scale 0 1 --classes 1", "--state", "series.txt",
        "--full-scale 0 1 --classes 1000000", "--full-scale 0 1 --classes 4.5"}) {
    const Outcome outcome = runCountCycles(arguments, "1\n2\n");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  }
  EXPECT_EQ(runCountCycles("--help", "").exit_code, 0);
}

}  // namespace
}  // namespace hammer_loads
