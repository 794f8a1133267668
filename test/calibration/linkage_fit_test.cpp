// Fits of bucket linkages to tables of stroke and angle, tested on linkages that are closed by Newton's method.
#include "hammer_loads/calibration/linkage_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "boom/linkage_reference.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

using Unknowns = LinkageUnknowns;
using test::LinkageReference;

constexpr double kClosed = 0.84;  // [m]

/// Returns the linkage of the shipped excavator's hammer cylinder.
LinkageReference excavator() {
  return {{{-1.35, 0.28}, {-0.26, 0.05}, {0.25, 0.13}, 1.0}, {-0.26, 0.05, 0.34, 0.31, -1.0}};
}

StrokeTable tableOf(const LinkageReference& linkage, double noise) {
  std::mt19937 random(5);
  std::normal_distribution<> normal;
  StrokeTable table;
  for (double angle = -1.85; angle < 0.06; angle += 0.04) {
    table.angle.push_back(angle);
    table.stroke.push_back(static_cast<double>(linkage.length(angle)) - kClosed + noise * normal(random));
  }
  return table;
}

/// Returns the rms error of the lever arm between the table's ends over the rms lever arm.
double leverError(const LinkageFit& fit, const LinkageReference& truth) {
  double off = 0.0, all = 0.0;
  for (double q = -1.83; q < 0.05; q += 0.03) {
    const double arm = static_cast<double>(truth.arm(q));
    off += std::pow(fit.linkage(1.0).at(std::cos(q), std::sin(q)).arm - arm, 2), all += arm * arm;
  }
  return std::sqrt(off / all);
}

/// A table read to 0.5 mm determines the lever arm, although it does not determine every length.
TEST(LinkageFits, FindTheLeverFromTheTableAlone) {
  const LinkageReference truth = excavator();
  const LinkageFit fit = fitLinkage(tableOf(truth, 5e-4), {}, "hammer_cylinder");
  ASSERT_EQ(fit.problem, "");
  EXPECT_TRUE(fit.determined());
  EXPECT_LT(fit.left, 1e-3);
  EXPECT_LT(leverError(fit, truth), 0.01);
  EXPECT_EQ(fit.remarks.size(), 1U) << "how the whole is turned does not show";
  EXPECT_FALSE(fit.correlations.empty());
}

/// Every length is also measured by tape to 1 cm. Each fitted length lies within three standard deviations, and the
/// lever arm is better than that of the tape.
TEST(LinkageFits, ImproveWhatATapeHasMeasured) {
  const LinkageReference truth = excavator();
  const Unknowns::Vector value =
      (Unknowns::Vector() << -1.35, 0.28, -0.26, 0.05, 0.34, 0.31, 0.25, 0.13, kClosed).finished();
  std::mt19937 random(6);
  std::normal_distribution<> normal;
  LinkageBasis basis;
  LinkageFit by_tape;
  by_tape.value = value, by_tape.branch = -1.0;
  for (int i = 0; i < Unknowns::kCount; ++i) {
    basis.measured[static_cast<std::size_t>(i)] = value[i] + 0.01 * normal(random);
    by_tape.value[i] = *basis.measured[static_cast<std::size_t>(i)];
  }
  const LinkageFit fit = fitLinkage(tableOf(truth, 5e-4), basis, "hammer_cylinder");
  ASSERT_EQ(fit.problem, "");
  EXPECT_EQ(fit.branch, -1.0);
  EXPECT_TRUE(fit.remarks.empty());
  for (int i = 0; i < Unknowns::kCount; ++i) {
    const Estimate& e = fit.estimates[static_cast<std::size_t>(i)];
    EXPECT_NEAR(e.value, value[i], 3.0 * e.deviation) << e.key;
    EXPECT_LE(e.deviation, 0.0101) << e.key;
  }
  EXPECT_LT(leverError(fit, truth), 0.005);
  EXPECT_GT(leverError(by_tape, truth), 0.01);
}

TEST(LinkageFits, RefuseTablesThatAreNone) {
  std::string problem;
  EXPECT_FALSE(readStrokeTable("angle,stroke\n1,2\n", problem));
  EXPECT_EQ(problem, "line 1: angle,stroke, must be the header stroke_m,angle_rad");
  EXPECT_FALSE(readStrokeTable("stroke_m,angle_rad\n0.1,0.2\n0.1\n", problem));
  EXPECT_EQ(problem, "line 3: 0.1, must be two numbers: a stroke up to 100 m, an angle up to 7 rad");
  EXPECT_FALSE(readStrokeTable("stroke_m,angle_rad\n0.1,nan\n", problem));
  EXPECT_FALSE(readStrokeTable("stroke_m,angle_rad\n0.1,0.2,\n", problem));
  EXPECT_FALSE(readStrokeTable("stroke_m,angle_rad\n0.1,0.2\n", problem));
  EXPECT_EQ(problem, "1 rows, must be at least 12 over the whole stroke");
  std::string good = "# tape measure\r\nstroke_m,angle_rad\r\n";
  for (int i = 0; i < 12; ++i) good += format(i % 2 == 0 ? "%g,%g\r\n" : "%g, %g\r\n", 0.05 * i, 0.1 * i);
  const std::optional<StrokeTable> table = readStrokeTable(good, problem);
  ASSERT_TRUE(table);
  EXPECT_EQ(table->angle.back(), 1.1);
}

}  // namespace
}  // namespace hammer_loads::calibration
