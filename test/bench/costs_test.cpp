// What the cost table says of errors and of costs.
#include <gtest/gtest.h>
#include <time.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <limits>
#include <set>

#include "hammer_loads/bench/load_ways.h"
#include "hammer_loads/bench/printed_formulas.h"
#include "hammer_loads/bench/timing.h"
#include "support/command.h"
#include "support/mo100.h"

namespace hammer_loads::accuracy {
namespace {

const HammerParameters kHammer = test::mo100LinkageParameters();

HardCase caseNamed(const std::string& name) {
  for (const HardCase& c : hardCases(kHammer)) {
    if (c.name == name) return c;
  }
  throw std::invalid_argument(name);
}

LoadWay wayNamed(const std::string& name) {
  for (const LoadWay& way : loadWays()) {
    if (way.name == name) return way;
  }
  throw std::invalid_argument(name);
}

TEST(LoadErrors, OfEveryLevelStayBelowTheBoundOnEveryHardCase) {
  for (const HardCase& hard_case : hardCases(kHammer)) {
    for (const Level level : {Level::kRocker, Level::kLinkage}) {
      const ExactCase exact(hard_case, level);
      for (const LoadWay& way : loadWays()) {
        if (way.level != level || way.group == "printed") continue;
        const Error error = errorOf(way.loads(hard_case), exact, way.parts);
        EXPECT_LE(error.relative, 1e-13) << way.group << ' ' << way.name << ", " << hard_case.name;
        EXPECT_LE(error.of_peak, 1e-14) << way.group << ' ' << way.name << ", " << hard_case.name;
      }
    }
  }
}

TEST(LoadErrors, SeeAWrongDigit) {
  const HardCase regular = caseNamed("regular turn");
  const ExactCase exact(regular, Level::kLinkage);
  std::vector<LinkLoads> loads = wayNamed("linkage with pins").loads(regular);
  double peak = 0.0;
  for (const LinkLoads& l : loads) peak = std::max(peak, std::hypot(l.wrench.force_x, l.wrench.force_z));
  loads[7].wrench.force_z += 1e-6 * peak;
  EXPECT_NEAR(errorOf(loads, exact, Parts::kWrench).of_peak, 1e-6, 1e-8);  // the peak lies between the states
  EXPECT_GT(errorOf(loads, exact, Parts::kWrench).relative, 1e-6);
  EXPECT_GT(errorOf(loads, exact, Parts::kForceZ).of_peak, 1e-6);  // of the peak of Fz alone
  loads = wayNamed("linkage with pins").loads(regular);
  loads[3].pins.crank_on_rod.x *= 1.0 + 1e-9;
  EXPECT_LT(errorOf(loads, exact, Parts::kWrench).relative, 1e-13);
  EXPECT_NEAR(errorOf(loads, exact, Parts::kPins).relative, 1e-9, 1e-9);
  loads[3].pins.hull_on_crank.z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(errorOf(loads, exact, Parts::kPins).relative));
}

HardCase atOffset(double offset) {
  HardCase one = caseNamed("regular turn");
  one.angles = {offset > 0.0 ? offset : kTwoPi + offset};
  return one;
}

TEST(PrintedFormulas, HoldInMidTurn) {
  HardCase middle = caseNamed("regular turn");
  middle.acceleration = -300.0;  // P0 without, here with acceleration and weight
  middle.angles.erase(std::remove_if(middle.angles.begin(), middle.angles.end(),
                                     [](double phi) { return phi < 0.5 || phi > kTwoPi - 0.5; }),
                      middle.angles.end());
  const ExactCase exact(middle, Level::kRocker);
  for (const char* name : {"P0 with inverse trigonometry", "P0 with sines and cosines"}) {
    const LoadWay way = wayNamed(name);
    EXPECT_LE(errorOf(way.loads(middle), exact, way.parts).relative, 1e-11) << name;
  }
}

TEST(PrintedFormulas, LoseTheirDigitsTowardsTheBlowWhereOursKeepThem) {
  for (const double side : {-1.0, 1.0}) {
    for (const auto& [offset, lost] : {std::pair{1e-3, 1e-11}, std::pair{1e-6, 1e-5}, std::pair{1e-9, 0.1}}) {
      const HardCase near_blow = atOffset(side * offset);
      const ExactCase exact(near_blow, Level::kRocker);
      for (const char* name : {"P0 with inverse trigonometry", "P0 with sines and cosines"}) {
        const LoadWay way = wayNamed(name);
        EXPECT_GE(errorOf(way.loads(near_blow), exact, way.parts).relative, lost) << name << ' ' << side * offset;
      }
      EXPECT_LE(errorOf(wayNamed("rocker with pins").loads(near_blow), exact, Parts::kPins).relative, 1e-14);
    }
  }
}

TEST(PrintedFormulas, SecondTransferFunctionLosesThreeDigitsBesideZero) {
  const PrintedFormulas printed(kHammer, Positions::kTrigonometry);
  const Mechanism mechanism = test::mechanismOf(kHammer);
  const NewtonEuler exact(kHammer, Level::kRocker);
  double worst_printed = 0.0, worst_ours = 0.0;
  for (int decade = 1; decade <= 12; ++decade) {
    for (const double digit : {1.0, 1.9, 2.7, 4.4, 6.1, 8.3}) {
      const double phi = digit * std::pow(10.0, -decade);
      const Real right = exact.at(Real(phi), 1, 0, {}).psi_accel;
      const auto error = [&](double du) { return static_cast<double>(abs(Real(du) / right - 1)); };
      worst_printed = std::max(worst_printed, error(printed.transfer(phi).du));
      worst_ours = std::max(worst_ours, error(motion(mechanism.linkage(), CrankAngle::fromAngle(phi)).du));
    }
  }
  std::printf("u' beside 0: printed %.1e, half-angle form %.1e\n", worst_printed, worst_ours);
  EXPECT_GE(worst_printed, 1e-13);
  EXPECT_LE(worst_ours, 5e-15);
}

TEST(Timing, GivesTheProcessorTimeOfAnEvaluation) {
  const auto spin = [] {
    timespec start{}, now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start);
    do clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    while (1e9 * static_cast<double>(now.tv_sec - start.tv_sec) + static_cast<double>(now.tv_nsec - start.tv_nsec) <
           1e5);
  };
  const Cost cost = costOf(100, spin);
  EXPECT_GE(cost.median, 1000.0);
  EXPECT_LE(cost.median, 1100.0);  // a call of the clock beyond the end
  EXPECT_GE(cost.spread, 0.0);
}

TEST(Command, CostsEveryWay) {
  // What it wrote before may go.
  const test::TemporaryFile file("{\"costs\": []}\n", ".json");
  const test::Outcome run = test::runCommand(HAMMER_LOADS_ACCURACY, "--only costs --force --json " + file.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const YAML::Node rows = YAML::LoadFile(file.path())["costs"];  // JSON is YAML
  std::set<std::string> groups;
  std::size_t loads = 0;
  for (const YAML::Node& row : rows) {
    const auto name = row["group"].as<std::string>() + ' ' + row["name"].as<std::string>();
    groups.insert(row["group"].as<std::string>());
    EXPECT_GT(row["ns"].as<double>(), 0.1) << name;
    EXPECT_LT(row["ns"].as<double>(), 1e6) << name;
    EXPECT_NEAR(row["per_second"].as<double>() * row["ns"].as<double>(), 1e9, 1e6) << name;
    EXPECT_NE(run.out.find("| " + row["name"].as<std::string>() + " |"), std::string::npos) << name;
    if (row["errors"].size() == hardCases(kHammer).size()) ++loads;
  }
  EXPECT_EQ(groups, (std::set<std::string>{"printed", "scalar", "batch", "crank", "pipeline", "life", "grapple"}));
  EXPECT_EQ(loads, loadWays().size());
}

TEST(Command, RefusesAFileThatCannotBeWritten) {
  const test::Outcome run = test::runCommand(HAMMER_LOADS_ACCURACY, "--json /nowhere/costs.json");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, "/nowhere/costs.json: cannot be written: No such file or directory\n");
  EXPECT_EQ(run.out, "");
}

TEST(Command, ReplacesNoFileThatItDidNotWrite) {
  const test::TemporaryFile written("{\"costs\": []}\n", ".json"), notes("notes\n", ".json");
  const auto expectRefused = [](const std::string& arguments, const std::string& reason) {
    const test::Outcome run = test::runCommand(HAMMER_LOADS_ACCURACY, "--json " + arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
    EXPECT_EQ(test::linesOf(run.err).size(), 1U) << run.err;
    EXPECT_EQ(run.out, "") << "before it computes";
  };
  expectRefused(written.path(), "exists already");
  expectRefused(notes.path() + " --force", "it holds no figures of this command");
  expectRefused(testing::TempDir() + " --force", "is a directory");
  EXPECT_EQ(test::contentOf(written.path()), "{\"costs\": []}\n");
  EXPECT_EQ(test::contentOf(notes.path()), "notes\n");
}

}  // namespace
}  // namespace hammer_loads::accuracy
