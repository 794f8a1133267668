// doc/tables.md against the tables that are made.
#include <gtest/gtest.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/Pulse.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "hammer_loads/ros/number_fields.h"
#include "hammer_loads/tables/table_writer.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

using Tables = std::map<std::string, std::vector<std::string>>;  // columns in their order

Tables documented() {
  Tables tables;
  std::string table;
  std::ifstream file(std::filesystem::path(HAMMER_LOADS_TEST_DATA) / "../../doc/tables.md");
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (line.rfind("## ", 0) == 0) {
      table = line.substr(3);
      if (table != "runs") tables[table].push_back("run_id");
    } else if (std::regex_match(line, found, std::regex(R"(\| (\w+) \| .+ \| .+ \|)")) && found[1] != "column") {
      tables[table].push_back(found[1]);
    }
  }
  return tables;
}

Tables made() {
  const test::TemporaryFile file("", ".sqlite");
  {
    TableWriter writer(file.path(), numberFieldsOf<Pulse>().columns(), numberFieldsOf<Blow>().columns());
    writer.finish();
    EXPECT_EQ(writer.problem(), "");
  }
  Tables tables;
  life::Database database(file.path(), life::Database::Use::kRead, 0);
  life::Database::Statement columns(
      database,
      "SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c WHERE m.type = 'table' "
      "ORDER BY m.name, c.cid");
  while (columns.step()) tables[columns.text(0)].push_back(columns.text(1));
  EXPECT_EQ(database.problem(), "");
  return tables;
}

TEST(TablesPage, NamesEveryTableAndColumn) {
  Tables page = documented();
  ASSERT_EQ(page.size(), 14U);
  // Of these the page leaves what the messages say.
  for (const auto& [table, fields] : {std::make_pair("turns", numberFieldsOf<Pulse>().columns()),
                                      std::make_pair("blows", numberFieldsOf<Blow>().columns())}) {
    for (const TableColumn& column : fields)
      if (column.name != "turn") page[table].push_back(column.name);
  }
  EXPECT_EQ(made(), page);
}

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
