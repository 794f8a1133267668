// evaluate computes loads from states, as a library function and as a command.
#include "hammer_loads/hammer/evaluate.h"

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <sstream>

#include "settings/hammer_yaml.h"
#include "support/command.h"
#include "support/csv.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::linesOf;
using test::Outcome;
using test::TemporaryFile;

const std::string kHeader = "crank_angle_rad,crank_speed_rad_s,crank_accel_rad_s2,hull_pitch_rad,gravity_m_s2";
const std::string kResultHeader =
    kHeader +
    ",rocker_angle_rad,rod_angle_rad,rocker_speed_rad_s,rocker_accel_rad_s2,hull_force_x_N,hull_force_z_N,"
    "hull_torque_y_Nm,drive_torque_y_Nm,R01_x_N,R01_z_N,R12_x_N,R12_z_N,R23_x_N,R23_z_N,R03_x_N,R03_z_N";

struct Table {
  std::vector<std::string> problems;
  std::string out;
};

Table evaluated(const std::string& input, Level level = Level::kLinkage,
                const HammerParameters& parameters = test::mo100LinkageParameters()) {
  const Mechanism mechanism = test::mechanismOf(parameters);
  std::istringstream in(input);
  std::ostringstream out;
  Table table;
  table.problems = evaluateTable(HullModel(mechanism, level), in, out);
  table.out = out.str();
  return table;
}

std::map<std::string, double> rowOf(const std::string& csv, std::size_t row) {
  const TemporaryFile file(csv, ".csv");
  const test::Csv table(file.path());
  std::map<std::string, double> numbers;
  for (const std::string& column : table.columns()) numbers[column] = table.number(row, column);
  return numbers;
}

double offsetOf(const std::string& text) { return crankAngleFromText(text).value().offset; }

/// Returns 2 pi turns + offset with this number of decimals.
std::string angleText(int turns, const std::string& offset, int decimals) {
  using Decimal = boost::multiprecision::cpp_dec_float_100;
  const Decimal two_pi("6.28318530717958647692528676655900576839433879875021164194988918461563");
  return Decimal(turns * two_pi + Decimal(offset)).str(decimals, std::ios::fixed);
}

TEST(CrankAngleText, KeepsTheOffsetThatItsDigitsWereWrittenFor) {
  EXPECT_EQ(offsetOf("6.2831853061795864769"), -1e-9);
  for (int turns : {-1000, -3, -1, 1, 2, 7, 1000000}) {
    for (const std::string offset : {"-0.1", "0.1", "-1e-6", "2.7e-9", "-1e-9", "1e-9", "-3.1e-12", "1e-14"}) {
      for (int decimals : {18, 19, 25, 38}) {
        const std::string text = angleText(turns, offset, decimals);
        EXPECT_EQ(offsetOf(text), std::stod(offset)) << text;
      }
    }
  }
}

TEST(CrankAngleText, ReadsFewDigitsExactly) {
  EXPECT_DOUBLE_EQ(offsetOf("6.28"), -0.00318530717958647692528676655900);
  EXPECT_DOUBLE_EQ(offsetOf("6.2832"), 0.00001469282041352307471323344099);
  EXPECT_DOUBLE_EQ(offsetOf("-12.566"), 0.00037061435917295385057353311801);
  EXPECT_DOUBLE_EQ(offsetOf("6.283185307179586"), -4.76925286766559e-16);   // 2 pi as double, 16 digits
  EXPECT_DOUBLE_EQ(offsetOf("6.2831853071795862"), -2.76925286766559e-16);  // and 17
  EXPECT_DOUBLE_EQ(offsetOf("0.62831853071795862e1"), -2.76925286766559e-16);
  EXPECT_EQ(offsetOf("1.25"), 1.25);
  EXPECT_EQ(offsetOf("-1e-300"), -1e-300);
  EXPECT_EQ(offsetOf("+.5"), 0.5);
}

TEST(CrankAngleText, RefusesWhatIsNoAngle) {
  for (const char* text : {"", "x", "nan", "inf", "-inf", "0x1p3", "1,5", "1.5.2", "1e", "--1", "1 2", "1e16",
                           "-1.1e15", "1e400", "\"1\""}) {
    EXPECT_FALSE(crankAngleFromText(text)) << text;
  }
}

/// Compares every row of a reference table: load errors relative to the column's peak, angle errors absolute.
void expectReference(const std::string& name, Level level, const HammerParameters& parameters, double angle_error,
                     double load_error) {
  const std::string path = std::string(HAMMER_LOADS_TEST_DATA) + "/" + name;
  const Table table = evaluated(test::contentOf(path), level, parameters);
  ASSERT_EQ(table.problems, std::vector<std::string>{});
  const TemporaryFile file(table.out, ".csv");
  const test::Csv result(file.path()), reference(path);
  ASSERT_EQ(result.size(), reference.size());
  EXPECT_EQ(result.columns(), reference.columns());
  double worst = 0.0;
  for (const std::string& column : reference.columns()) {
    const bool is_angle = column.find("angle_rad") != std::string::npos;
    const bool is_motion = column.find("rocker_") == 0 || column.find("rod_") == 0;
    const double peak = is_angle ? 1.0 : reference.peak(column);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double error = std::abs(result.number(i, column) - reference.number(i, column));
      EXPECT_LE(error, (is_motion ? angle_error : load_error) * peak) << name << ' ' << column << " row " << i + 1;
      if (peak > 0.0) worst = std::max(worst, error / peak);
    }
  }
  std::printf("%s: %zu rows, worst error over the column's peak %.2e\n", name.c_str(), result.size(), worst);
}

TEST(Evaluate, EqualsTheReferenceOfTheWholeLinkage) {
  expectReference("mo100_linkage.csv", Level::kLinkage, test::mo100LinkageParameters(), 1e-12, 1e-12);
}

TEST(Evaluate, TakesColumnsInAnyOrderAndIgnoresOthers) {
  const Table usual = evaluated(kHeader + "\n5.9,30,-200,0.3,9.81\n1,2,3,4,5\n");
  ASSERT_EQ(usual.problems, std::vector<std::string>{});
  EXPECT_EQ(linesOf(usual.out).at(0), kResultHeader);
  const Table other = evaluated(
      "\xEF\xBB\xBFnote, gravity_m_s2,hull_pitch_rad "
      ",crank_speed_rad_s,rocker_angle_rad,crank_accel_rad_s2,crank_angle_rad\r\n"
      "peak, 9.81,0.3 ,30,7,-200,5.9\r\n\r\n,5,4,2,,3,1");
  EXPECT_EQ(other.out, usual.out);
  EXPECT_EQ(evaluated(usual.out).out, usual.out);  // results can be read again
}

TEST(Evaluate, RepeatsTheStateAsGivenAndPrintsSeventeenDigits) {
  const std::string state = "6.2831853061795864769,3.10e1,+200.,-0,9.80665000";
  const std::string line = linesOf(evaluated(kHeader + "\n" + state + "\n").out).at(1);
  EXPECT_EQ(line.rfind(state + ",", 0), 0U) << line;
  const Mechanism mechanism = test::mechanismOf(test::mo100LinkageParameters());
  const HullWrench right =
      hullWrench(mechanism, Level::kLinkage, {CrankAngle::fromOffset(-1e-9), 31.0, 200.0}, {0.0, -9.80665});
  const auto row = rowOf(kResultHeader + "\n" + line + "\n", 0);
  EXPECT_EQ(row.at("hull_force_x_N"), right.force_x);
  EXPECT_EQ(row.at("hull_force_z_N"), right.force_z);
  EXPECT_EQ(row.at("hull_torque_y_Nm"), right.torque_y);
}

void expectProblems(const std::string& input, const std::vector<std::string>& problems) {
  const Table table = evaluated(input);
  EXPECT_EQ(table.problems, problems);
  EXPECT_EQ(table.out, "");
}

TEST(Evaluate, BadRowsAreNamedAndNothingIsWritten) {
  const std::string good = "1,2,3,0.4,5\n";
  expectProblems(kHeader + "\n" + good + "x,2,3,4,5\n" + "1,,3,4,5\n\n" + "1,2,nan,4,-9.81\n" + good,
                 {"row 2: crank_angle_rad: x rad, must be a finite number of size <= 1e15",
                  "row 3: crank_speed_rad_s: (empty) rad/s, must be a finite number",
                  "row 5: crank_accel_rad_s2: nan rad/s2, must be a finite number",
                  "row 5: gravity_m_s2: -9.81 m/s2, must be a finite number >= 0"});
  expectProblems(kHeader + "\n1,2,3,1e999,5\n2e15,2,3,0x4,5\n",
                 {"row 1: hull_pitch_rad: 1e999 rad, must be a finite number",
                  "row 2: crank_angle_rad: 2e15 rad, must be a finite number of size <= 1e15",
                  "row 2: hull_pitch_rad: 0x4 rad, must be a finite number"});
  expectProblems(kHeader + "\n" + good + "1,2,3,4\n1,2,3,4,5,6\n",
                 {"row 2: 4 cells, must be 5 as in the header", "row 3: 6 cells, must be 5 as in the header"});
  expectProblems(kHeader + "\n1,1e200,3,4,5\n",
                 {"row 1: rocker_accel_rad_s2: -inf, must be finite: the state is too large"});
}

TEST(Evaluate, ManyBadRowsGiveTwentyLines) {
  std::string input = kHeader + "\n";
  for (int i = 0; i < 1000; ++i) input += "1,2,3,4,bad\n";
  const Table table = evaluated(input);
  ASSERT_EQ(table.problems.size(), 20U);
  EXPECT_EQ(table.problems.back(), "and 981 more");
  EXPECT_EQ(table.out, "");
}

TEST(Evaluate, ABadHeaderIsNamed) {
  const std::string missing = "header: missing, must be a line with the names of the columns";
  expectProblems("", {missing});
  expectProblems("\n", {missing});
  expectProblems("crank_angle_rad,crank_speed,crank_accel_rad_s2,hull_pitch_rad,gravity_m_s2\n1,2,3,4,5\n",
                 {"header: crank_speed_rad_s: is required, not found"});
  expectProblems(kHeader + ",crank_angle_rad\n1,2,3,4,5,6\n", {"header: crank_angle_rad: found 2 times, must be once"});
}

Outcome runEvaluate(const std::string& arguments, const std::string& input) {
  return test::runCommand(HAMMER_LOADS_EVALUATE, arguments, input);
}

TEST(EvaluateCommand, TakesLevelAndMachineFromFilesInOrder) {
  const std::string input = kHeader + "\n6,31.416,0,0.2,9.8\n";
  const TemporaryFile rocker("level: rocker\n"), pulse("level: pulse\n");
  const TemporaryFile light(test::hammerYaml({{"rocker_mass_kg", "17.6"}}));
  EXPECT_EQ(runEvaluate("", input).out, runEvaluate("--level linkage", input).out);
  EXPECT_EQ(runEvaluate("--params " + rocker.path(), input).out, runEvaluate("--level rocker", input).out);
  EXPECT_EQ(runEvaluate("--params " + rocker.path() + " --params " + pulse.path(), input).out,
            runEvaluate("--level pulse", input).out);
  EXPECT_EQ(runEvaluate("--params " + rocker.path() + " --level linkage", input).out,
            runEvaluate("--level linkage", input).out);
  const double force = rowOf(runEvaluate("--level rocker", input).out, 0).at("hull_force_x_N");
  EXPECT_NEAR(rowOf(runEvaluate("--level rocker --params " + light.path(), input).out, 0).at("hull_force_x_N"),
              0.5 * force, 1e-9);
}

TEST(EvaluateCommand, BadInputIsOneLineEachAndExitCode1) {
  const Outcome outcome = runEvaluate("", kHeader + "\n1,2,3,4,5\n1,2,3,4,-5\n1,fast,3,4,5\n");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            "stdin: row 2: gravity_m_s2: -5 m/s2, must be a finite number >= 0\n"
            "stdin: row 3: crank_speed_rad_s: fast rad/s, must be a finite number\n");
  EXPECT_EQ(runEvaluate("", "").exit_code, 1);
  EXPECT_EQ(runEvaluate("--params /no/such/file.yaml", kHeader + "\n").exit_code, 1);
}

}  // namespace
}  // namespace hammer_loads
