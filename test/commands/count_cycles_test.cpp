// Tests of the command count_cycles.
#include <gtest/gtest.h>

#include "support/command.h"

namespace hammer_loads {
namespace {

using test::linesOf;
using test::Outcome;

Outcome runCountCycles(const std::string& arguments, const std::string& input) {
  return test::runCommand(HAMMER_LOADS_COUNT_CYCLES, arguments, input);
}

const std::string kFigure6 = "-2\n1\n-3\n5\n-1\n3\n-4\n4\n-2\n";
const std::string kCount =
    "range,mean,count\n3,-0.5,0.5\n4,-1,0.5\n4,1,1\n6,1,0.5\n8,0,0.5\n8,1,0.5\n9,0.5,0.5\n";  // ASTM E1049-85, Fig. 6

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
        "--exact --full-scale 0 1", "--full-scale 0 1 --classes 1", "--state file", "series.txt",
        "--full-scale 0 1 --classes 1000000", "--full-scale 0 1 --classes 4.5"}) {
    const Outcome outcome = runCountCycles(arguments, "1\n2\n");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  }
}

}  // namespace
}  // namespace hammer_loads
