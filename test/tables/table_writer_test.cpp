// A run's row as it is written.
#include "hammer_loads/tables/table_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

/// fill: what is written.
template <typename Fill>
void writeTables(const std::string& file, const Fill& fill) {
  TableWriter writer(file, {{"turn", true, "-", {}}}, {{"turn", true, "-", {}}});
  fill(writer);
  writer.finish();
  ASSERT_EQ(writer.problem(), "");
}

TEST(TableWriter, KeepsTheBoomsHealth) {
  const test::TemporaryFile file("");
  writeTables(file.path(), [](TableWriter& writer) {
    writer.boomCylinder(1, {7, "arm_cylinder", -0.5, 0.9, 0.01, true});
    writer.boomMode(1, {7, 2, 8.5, 0.1, 0.05, std::numeric_limits<double>::quiet_NaN()});
  });
  life::Database database(file.path(), life::Database::Use::kRead, 0);
  life::Database::Statement rows(
      database,
      "SELECT turn, joint_angle, stiffness_ratio, stiffness_ratio_std, doubtful, mode, frequency, "
      "frequency_std, damping_ratio, damping_ratio_std FROM boom_cylinders JOIN boom_modes "
      "USING(run_id, turn) WHERE run_id = 1 AND cylinder = 'arm_cylinder'");
  ASSERT_TRUE(rows.step());
  const double expected[] = {7, -0.5, 0.9, 0.01, 1, 2, 8.5, 0.1, 0.05};
  for (int i = 0; i < 9; ++i) EXPECT_EQ(rows.number(i), expected[i]) << i;
  EXPECT_TRUE(std::isnan(rows.number(9)));
  EXPECT_FALSE(rows.step());
}

/// What nothing measured is NULL, which is not zero.
TEST(TableWriter, MisuseThatIsNotKnownIsNull) {
  const test::TemporaryFile file("");
  writeTables(file.path(), [](TableWriter& writer) {
    RunRecord record;
    record.blank_firings = 3;
    writer.run(1, record);
    record.judged_blows = 50;
    record.blows_without_hold_down = 7;
    record.still_time = 12.5;
    record.hull_pitch = -0.25;
    writer.run(2, record);
  });
  life::Database database(file.path(), life::Database::Use::kRead, 0);
  life::Database::Statement rows(
      database,
      "SELECT blank_firings, judged_blows, blows_without_hold_down, still_time, blows_without_hold_down IS "
      "NULL, hull_pitch FROM runs ORDER BY run_id");
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.integer(0), 3);
  EXPECT_EQ(rows.integer(1), 0);
  EXPECT_EQ(rows.integer(4), 1);
  EXPECT_TRUE(std::isnan(rows.number(3)));
  EXPECT_TRUE(std::isnan(rows.number(5)));
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.integer(1), 50);
  EXPECT_EQ(rows.integer(2), 7);
  EXPECT_EQ(rows.number(3), 12.5);
  EXPECT_EQ(rows.number(5), -0.25);
}

}  // namespace
}  // namespace hammer_loads
