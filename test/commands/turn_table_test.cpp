// The command turn_table as its user meets it: what it prints, its errors and exit codes.
#include <cmath>
#include <map>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/pin_forces.h"
#include "settings/hammer_yaml.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

using test::contentOf;
using test::hammerYaml;
using test::linesOf;
using test::numbersOf;
using test::Outcome;
using test::TemporaryFile;

Outcome runTurnTable(const std::string& arguments) { return test::runCommand(HAMMER_LOADS_TURN_TABLE, arguments); }

/// `key: value` lines.
std::map<std::string, double> summaryOf(const std::string& arguments) {
  std::map<std::string, double> summary;
  for (const std::string& line : linesOf(runTurnTable("--summary " + arguments).out)) {
    const std::size_t colon = line.find(": ");
    summary[line.substr(0, colon)] = std::stod(line.substr(colon + 2));
  }
  return summary;
}

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
}

TEST(TurnTable, RowsAreTheModelsToTwelveDigits) {
  const Settings settings = loadFiles(configDirectory(), {}).value.value();
  const std::vector<std::string> lines =
      linesOf(runTurnTable("--level rocker --speed 20 --step-deg 7.3 --pitch 0.3").out);
  ASSERT_EQ(lines.size(), 1U + 50U + 1U);  // 0 to 357.7, and 360
  const double g = settings.pipeline.gravity;
  for (std::size_t i = 1; i < 51; ++i) {
    const std::vector<double> row = numbersOf(lines[i]);
    const HullWrench right = hullWrench(settings.mechanism, Level::kRocker,
                                        {CrankAngle::fromAngle(row[0] / 180.0 * std::acos(-1.0)), 20.0, 0.0},
                                        {g * std::sin(0.3), -g * std::cos(0.3)});
    EXPECT_NEAR(row[2], right.force_x, 1e-7);
    EXPECT_NEAR(row[3], right.force_z, 1e-7);
    EXPECT_NEAR(row[4], right.torque_y, 1e-7);
  }
  EXPECT_EQ(numbersOf(lines.back())[0], 360.0);
}

TEST(TurnTable, WeightCountsOnlyWithAPitch) {
  const auto forceAtStart = [](const std::string& pitch) {
    return numbersOf(linesOf(runTurnTable("--level rocker --step-deg 360 " + pitch).out).at(1)).at(3);
  };
  EXPECT_NEAR(forceAtStart(""), 0.0, 1e-9);
  EXPECT_NEAR(forceAtStart("--pitch 0"), -35.2 * 9.80665, 1e-8);
}

TEST(TurnTable, TakesParameterFilesInOrder) {
  const TemporaryFile light(hammerYaml({{"rocker_mass_kg", "17.6"}})), heavy("rocker_mass_kg: 35.2\n");
  const std::string mo100 = linesOf(runTurnTable("--summary --level rocker").out).at(0);
  const std::string files = "--params " + light.path() + " --params " + heavy.path();
  EXPECT_EQ(linesOf(runTurnTable("--summary --level rocker " + files).out).at(0), mo100);
  EXPECT_EQ(linesOf(runTurnTable("--summary --level rocker --params " + light.path()).out).at(0),
            "amplitude_N: 20279.0197608");
}

TEST(TurnTable, PinsAddsTheModelsPinForcesAndDriveTorque) {
  const Settings settings = loadFiles(configDirectory(), {}).value.value();
  const std::string plain = runTurnTable("--step-deg 10 --level linkage --pitch 0.3").out;
  const std::vector<std::string> lines = linesOf(runTurnTable("--step-deg 10 --level linkage --pitch 0.3 --pins").out);
  ASSERT_EQ(lines.size(), 1U + 37U);
  EXPECT_EQ(lines[0],
            "crank_angle_deg,time_s,force_x_N,force_z_N,torque_y_Nm,drive_torque_y_Nm,"
            "R01_x_N,R01_z_N,R12_x_N,R12_z_N,R23_x_N,R23_z_N,R03_x_N,R03_z_N");
  const double g = settings.pipeline.gravity;
  for (std::size_t i = 2; i + 1 < lines.size(); ++i) {
    EXPECT_EQ(lines[i].rfind(linesOf(plain)[i] + ",", 0), 0U) << lines[i];
    const std::vector<double> row = numbersOf(lines[i]);
    const PinReactions right = pinForces(settings.mechanism, Level::kLinkage,
                                         {CrankAngle::fromAngle(row[0] / 180.0 * std::acos(-1.0)), 31.416, 0.0},
                                         {g * std::sin(0.3), -g * std::cos(0.3)}, NearBlow(0.01));
    const double values[] = {right.drive_torque,    right.hull_on_crank.x,  right.hull_on_crank.z,
                             right.crank_on_rod.x,  right.crank_on_rod.z,   right.rod_on_rocker.x,
                             right.rod_on_rocker.z, right.hull_on_rocker.x, right.hull_on_rocker.z};
    for (std::size_t c = 0; c < 9; ++c) EXPECT_NEAR(row[5 + c], values[c], 1e-6) << row[0] << ' ' << c;
  }
}

TEST(TurnTable, PinsOfAMasslessRodAreFiniteOnBothSidesOfTheBlow) {
  const std::vector<std::string> lines = linesOf(runTurnTable("--step-deg 180 --level rocker --pins").out);
  ASSERT_EQ(lines.size(), 1U + 3U);
  const std::vector<double> after = numbersOf(lines[1]), before = numbersOf(lines[3]);
  // Rows 1e-9 rad after and before the blow of reference mo100_constant_speed.csv.
  EXPECT_NEAR(after[6], -467.9712728, 1e-6);
  EXPECT_NEAR(after[7], -557.7064457, 1e-6);
  EXPECT_NEAR(before[6], -299003.80, 1e-2);
  EXPECT_NEAR(before[7], -356338.86, 1e-2);
}

TEST(TurnTable, LevelPulseIsTheHalfSineOfTheNominalTurn) {
  auto rocker = summaryOf("--level rocker"), pulse = summaryOf("--level pulse");
  for (const char* key : {"amplitude_N", "impulse_Ns", "frequency_rad_s", "start_s"})
    EXPECT_NEAR(pulse[key], rocker[key], 1e-11 * rocker[key]) << key;
  EXPECT_EQ(pulse["turn_impulse_x_Ns"], 0.0);
  EXPECT_NEAR(pulse["turn_impulse_z_Ns"], rocker["impulse_Ns"], 1e-9);
  const double w = 31.416, degree = std::acos(-1.0) / 180.0;
  for (const std::string& line : linesOf(runTurnTable("--level pulse --step-deg 3").out)) {
    if (line[0] == 'c') continue;
    const std::vector<double> row = numbersOf(line);
    const double right =
        row[0] * degree / w < pulse["start_s"]
            ? 0.0
            : pulse["amplitude_N"] * std::sin(pulse["frequency_rad_s"] * (row[0] * degree / w - pulse["start_s"]));
    EXPECT_EQ(row[2], 0.0);
    EXPECT_NEAR(row[3], right, 1e-5) << row[0];  // the summary's 12 digits of start_s
    EXPECT_EQ(row[4], 0.0);
  }
}

TEST(TurnTable, LevelPulseWithWeightHasThePulseOfItsOwnTable) {
  for (const std::string pitch : {"0.4", "2.9"}) {  // tool down, tool up
    auto summary = summaryOf("--level pulse --pitch " + pitch);
    const std::vector<std::string> lines = linesOf(runTurnTable("--level pulse --step-deg 0.01 --pitch " + pitch).out);
    double peak = 0.0, peak_angle = 0.0, lobe = 0.0, turn = 0.0, last = 0.0;
    const double time_step = 0.01 / 180.0 * std::acos(-1.0) / 31.416;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::vector<double> row = numbersOf(lines[i]);
      if (row[3] > peak) peak = row[3], peak_angle = row[0];
      if (last < 0.0 && row[3] >= 0.0) lobe = 0.0;
      if (i > 1) lobe += 0.5 * (last + row[3]) * time_step, turn += 0.5 * (last + row[3]) * time_step;
      last = row[3];
    }
    EXPECT_NEAR(summary["amplitude_N"], peak, 0.01);  // half a step beside the peak: 0.003 N
    EXPECT_NEAR(summary["peak_angle_deg"], peak_angle, 0.01);
    EXPECT_NEAR(summary["impulse_Ns"], lobe, 1e-3);
    EXPECT_NEAR(summary["turn_impulse_z_Ns"], turn, 1e-3);
    EXPECT_NEAR(summary["frequency_rad_s"], 2.0 * peak / lobe, 1e-3);
  }
}

TEST(TurnTable, BadParametersAreNamedAndGiveExitCode1) {
  const TemporaryFile bad(hammerYaml({{"crank_length_m", "-0.048"}, {"rod_mass_kg", "\"4.5\""}}) + "levle: rocker\n");
  const Outcome outcome = runTurnTable("--params " + bad.path());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.out, "");
  const std::vector<std::string> lines = linesOf(outcome.err);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].rfind("rod_mass_kg: \"4.5\" kg, must be a finite number", 0), 0U) << lines[0];
  EXPECT_EQ(lines[1].rfind("crank_length_m: -0.048 m, must be > 0", 0), 0U) << lines[1];
  EXPECT_EQ(lines[2].rfind("levle: unknown key, perhaps level was meant", 0), 0U) << lines[2];
  EXPECT_EQ(runTurnTable("--params /no/such/file.yaml").exit_code, 1);
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
}

TEST(TurnTable, HelpIsNoError) {
  const Outcome outcome = runTurnTable("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("--step-deg"), std::string::npos);
}

TEST(TurnTable, UnwritableOutputIsAnError) {
  const TemporaryFile err({}, ".err");
  const int status = std::system((std::string(HAMMER_LOADS_TURN_TABLE) + " >/dev/full 2>" + err.path()).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_EQ(contentOf(err.path()), "stdout: cannot be written\n");
}

}  // namespace
}  // namespace hammer_loads
