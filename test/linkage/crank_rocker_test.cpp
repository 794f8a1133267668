#include <gtest/gtest.h>

#include <limits>

#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {
namespace {

constexpr LinkLengths kMo100{0.048, 0.150, 0.120, 0.078};

TEST(CrankRocker, CorrectsTheRodWithinToleranceAndReportsIt) {
  LinkLengths rounded = kMo100;
  rounded.rod += 0.9e-3 * rounded.crank;
  const Checked<CrankRocker> made = CrankRocker::make(rounded);
  ASSERT_TRUE(made.value);
  EXPECT_NEAR(made.value->lengths().rod, 0.150, 1e-15);
  ASSERT_EQ(made.notes.size(), 1u);
  EXPECT_NE(made.notes[0].find("rod_length_m: 0.1500432 m corrected by -4.32e-05 m to 0.15 m"), std::string::npos)
      << made.notes[0];
}

TEST(CrankRocker, RefusesALargerMissWithTheInequalityAndItsNumbers) {
  LinkLengths lengths = kMo100;
  lengths.rod = 0.151;
  const Checked<CrankRocker> made = CrankRocker::make(lengths);
  EXPECT_FALSE(made.value);
  ASSERT_EQ(made.problems.size(), 1u);
  for (const char* part : {"rod_length_m", "0.048", "0.151", "0.12", "0.078", "0.001 m", "<= 1e-3", "4.8e-05"}) {
    EXPECT_NE(made.problems[0].find(part), std::string::npos) << part << " in " << made.problems[0];
  }
}

TEST(CrankRocker, RefusesACrankThatCannotTurn) {
  const Checked<CrankRocker> long_crank = CrankRocker::make({0.08, 0.118, 0.120, 0.078});
  EXPECT_FALSE(long_crank.value);
  ASSERT_EQ(long_crank.problems.size(), 1u);
  EXPECT_NE(long_crank.problems[0].find("crank_length_m: 0.08 m, must be < pivot_distance_m = 0.078 m"),
            std::string::npos);
  const Checked<CrankRocker> short_rocker = CrankRocker::make({0.05, 0.068, 0.040, 0.078});
  EXPECT_FALSE(short_rocker.value);
  EXPECT_NE(short_rocker.problems[0].find("rocker_length_m = 0.04 m"), std::string::npos);
}

TEST(CrankRocker, ReportsEveryLengthThatIsNotPositiveAndFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Checked<CrankRocker> made = CrankRocker::make({0.0, -0.1, nan, inf});
  EXPECT_FALSE(made.value);
  ASSERT_EQ(made.problems.size(), 4u);
  EXPECT_EQ(made.problems[0].find("crank_length_m: 0 m"), 0u);
  EXPECT_EQ(made.problems[1].find("rod_length_m: -0.1 m"), 0u);
  EXPECT_EQ(made.problems[2].find("rocker_length_m: nan m"), 0u);
  EXPECT_EQ(made.problems[3].find("pivot_distance_m: inf m"), 0u);
}

TEST(CrankRocker, ScalesFromMicrometresToKilometres) {
  for (double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const Checked<CrankRocker> made = CrankRocker::make({scale * 0.048, scale * 0.150, scale * 0.120, scale * 0.078});
    ASSERT_TRUE(made.value) << scale;
    EXPECT_NEAR(made.value->ratios().g, 3.125 * 2.5 / 1.625 - 1.0, 1e-14);
  }
}

}  // namespace
}  // namespace hammer_loads
