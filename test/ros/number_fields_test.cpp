#include "hammer_loads/ros/number_fields.h"

#include <gtest/gtest.h>
#include <hammer_loads/Blow.h>

#include <stdexcept>

namespace hammer_loads {
namespace {

TEST(NumberFields, AreThoseOfTheMessageInTheirOrder) {
  Blow blow;
  blow.header.frame_id = "hammer_hull";
  blow.turn = 7;
  blow.crank_speed_before = 11.5;
  blow.mean_hold_down_force = -2.25;
  blow.struck = Blow::STRUCK_TOOL;
  blow.flags = Blow::FLAG_IMPOSSIBLE;
  NumberFields fields = numberFieldsOf<Blow>();
  const std::vector<TableColumn> columns = fields.columns();
  const std::vector<double> values = fields.valuesOf(blow);
  ASSERT_EQ(values.size(), columns.size());
  EXPECT_EQ(columns.front().name, "turn");
  EXPECT_TRUE(columns.front().is_integer);
  EXPECT_EQ(values.front(), 7.0);
  EXPECT_EQ(columns[1].name, "crank_speed_before");
  EXPECT_FALSE(columns[1].is_integer);
  EXPECT_EQ(values[1], 11.5);
  const std::size_t last = columns.size() - 1;
  EXPECT_EQ(columns[last - 1].name, "struck");
  EXPECT_TRUE(columns[last - 1].is_integer);
  EXPECT_EQ(values[last - 1], 1.0);
  EXPECT_EQ(columns[last - 2].name, "mean_hold_down_force");
  EXPECT_EQ(values[last - 2], -2.25);
  EXPECT_EQ(columns[last].name, "flags") << "a constant is no column";
  EXPECT_TRUE(columns[last].is_integer);
  EXPECT_EQ(values[last], 1.0);
  blow.header.frame_id = "another, longer name";
  EXPECT_EQ(fields.valuesOf(blow)[last - 2], -2.25);
}

TEST(NumberFields, KnowEveryNumberAndRefuseTheRest) {
  NumberFields fields(
      "Header header # first\nbool a\nint8 b\nuint16 FLAG = 4 # a constant\nuint16 c\nfloat32 d\n\n"
      "int64 e # last\n====\nMSG: other\nstring text\n");
  const std::vector<TableColumn> columns = fields.columns();
  ASSERT_EQ(columns.size(), 5U);
  EXPECT_EQ(columns[3].name, "d");
  EXPECT_FALSE(columns[3].is_integer);
  EXPECT_TRUE(columns[4].is_integer);
  EXPECT_THROW(NumberFields("Header header\nfloat64[] values\n"), std::invalid_argument);
  EXPECT_THROW(NumberFields("Header header\nstring name\n"), std::invalid_argument);
}

}  // namespace
}  // namespace hammer_loads
