// A run's row as it is written.
#include "hammer_loads/tables/table_writer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

/// What nothing measured is NULL, which is not zero.
TEST(TableWriter, MisuseThatIsNotKnownIsNull) {
  const test::TemporaryFile file("");
  {
    TableWriter writer(file.path(), {{"turn", true}}, {{"turn", true}});
    RunRecord record;
    record.blank_strokes = 3;
    writer.run(1, record);
    record.judged_blows = 50;
    record.unpressed_blows = 7;
    record.still_time = 12.5;
    writer.run(2, record);
    writer.finish();
    ASSERT_EQ(writer.problem(), "");
  }
  life::Database database(file.path(), life::Database::Use::kRead, 0);
  life::Database::Statement rows(
      database,
      "SELECT blank_strokes, judged_blows, unpressed_blows, still_time_s, unpressed_blows IS "
      "NULL FROM runs ORDER BY run_id");
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.integer(0), 3);
  EXPECT_EQ(rows.integer(1), 0);
  EXPECT_EQ(rows.integer(4), 1);
  EXPECT_TRUE(std::isnan(rows.number(3)));
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.integer(1), 50);
  EXPECT_EQ(rows.integer(2), 7);
  EXPECT_EQ(rows.number(3), 12.5);
}

}  // namespace
}  // namespace hammer_loads
