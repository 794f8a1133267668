// The command turn_table: output, errors and exit codes.
#include <cmath>

#include "support/command.h"

namespace hammer_loads {
namespace {

using test::linesOf;
using test::numbersOf;
using test::Outcome;

Outcome runTurnTable(const std::string& arguments) { return test::runCommand(HAMMER_LOADS_TURN_TABLE, arguments); }

TEST(TurnTable, SummaryGivesThePapersPulse) {
  const Outcome outcome = runTurnTable("--speed 31.416 --level rocker --summary");
  EXPECT_EQ(outcome.exit_code, 0);
  const std::vector<std::pair<std::string, double>> right{
      {"amplitude_N", 40558.0395215},      {"peak_angle_deg", 348.480359663}, {"impulse_Ns", 483.218440034},
      {"frequency_rad_s", 167.866273972},  {"start_s", 0.181284679239},       {"turn_impulse_x_Ns", 0.0},
      {"turn_impulse_z_Ns", 534.602622037}};
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    const std::size_t colon = lines[i].find(": ");
    ASSERT_NE(colon, std::string::npos) << lines[i];
    EXPECT_EQ(lines[i].substr(0, colon), right[i].first);
    EXPECT_NEAR(std::stod(lines[i].substr(colon + 2)), right[i].second, 1e-9 * std::max(1.0, right[i].second));
  }
}

TEST(TurnTable, HasOneRowPerStepAndBothSidesOfTheBlow) {
  const Outcome outcome = runTurnTable("--speed 31.416 --level rocker --step-deg 1");
  EXPECT_EQ(outcome.exit_code, 0);
  const std::vector<std::string> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 1U + 361U);
  EXPECT_EQ(lines[0], "crank_angle_deg,time_s,force_x_N,force_z_N,torque_y_Nm");
  for (std::size_t i = 0; i <= 360; ++i) {
    const std::vector<double> row = numbersOf(lines[i + 1]);
    ASSERT_EQ(row.size(), 5U);
    EXPECT_EQ(row[0], static_cast<double>(i));
    EXPECT_NEAR(row[1], row[0] / 180.0 * std::acos(-1.0) / 31.416, 1e-11);
  }
  EXPECT_NEAR(numbersOf(lines[351])[3], 39899.7, 0.05);   // P0's own curve at 350 deg
  EXPECT_NEAR(numbersOf(lines[361])[2], -55448.8, 0.05);  // just before the blow
  EXPECT_NEAR(numbersOf(lines[1])[2], -1704.5752, 1e-3);  // just after it
  EXPECT_EQ(linesOf(runTurnTable("--step-deg 360 --pins").out).at(0),
            lines[0] + ",drive_torque_y_Nm,R01_x_N,R01_z_N,R12_x_N,R12_z_N,R23_x_N,R23_z_N,R03_x_N,R03_z_N");
}

TEST(TurnTable, WeightCountsOnlyWithAPitch) {
  const auto forceAtStart = [](const std::string& pitch) {
    return numbersOf(linesOf(runTurnTable("--level rocker --step-deg 360 " + pitch).out).at(1)).at(3);
  };
  EXPECT_NEAR(forceAtStart(""), 0.0, 1e-9);
  EXPECT_NEAR(forceAtStart("--pitch 0"), -35.2 * 9.80665, 1e-8);
}

TEST(TurnTable, WrongUsageIsOneLineAndExitCode2) {
  for (const char* arguments : {"--speed 0", "--speed -1", "--speed nan", "--speed inf", "--speed fast", "--speed",
                                "--step-deg 0", "--step-deg -1", "--step-deg 361", "--step-deg nan", "--level hammer",
                                "--pitch inf", "--no-such-option", "stray", "--params"}) {
    const Outcome outcome = runTurnTable(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(linesOf(outcome.err).size(), 1U) << arguments << ": " << outcome.err;
  }
  EXPECT_EQ(runTurnTable("--params /no/such/file.yaml").exit_code, 1);
}

}  // namespace
}  // namespace hammer_loads
