// doc/tables.md against the tables that are made.
#include <gtest/gtest.h>
#include <hammer_loads/Blow.h>
#include <hammer_loads/Pulse.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <utility>

#include "hammer_loads/life/channel_unit.h"
#include "hammer_loads/ros/number_fields.h"
#include "hammer_loads/tables/table_writer.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

/// Table, column, unit, description.
using Columns = std::map<std::pair<std::string, std::string>, std::pair<std::string, std::string>>;

/// Tables `turns` and `blows` have every field of their message as well, which the page does not repeat; every table
/// but `runs` and `columns` has run_id.
Columns documented() {
  Columns columns;
  std::string table;
  std::ifstream file(std::filesystem::path(HAMMER_LOADS_TEST_DATA) / "../../doc/tables.md");
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (line.rfind("## ", 0) == 0) table = line.substr(3);
    if (std::regex_match(line, found, std::regex(R"(\| (\w+) \| (.+) \| (.+) \|)")) && found[1] != "column")
      columns[{table, found[1]}] = {found[2], found[3]};
  }
  return columns;
}

class TablesPage : public testing::Test {
 protected:
  void SetUp() override {
    TableWriter writer(file_.path(), numberFieldsOf<Pulse>().columns(), numberFieldsOf<Blow>().columns());
    writer.finish();
    ASSERT_EQ(writer.problem(), "");
  }
  std::vector<std::pair<std::string, std::string>> pairs(const char* sql) {
    life::Database database(file_.path(), life::Database::Use::kRead, 0);
    life::Database::Statement rows(database, sql);
    std::vector<std::pair<std::string, std::string>> result;
    while (rows.step()) result.emplace_back(rows.text(0), rows.text(1));
    return result;
  }
  const test::TemporaryFile file_{"", ".sqlite"};
};

TEST_F(TablesPage, EveryColumnHasUnitAndDescription) {
  EXPECT_EQ(pairs("SELECT table_name, column_name FROM columns ORDER BY 1, 2"),
            pairs("SELECT m.name, c.name FROM sqlite_master m, pragma_table_info(m.name) c WHERE m.type = 'table' "
                  "ORDER BY 1, 2"));
  EXPECT_TRUE(pairs("SELECT table_name, column_name FROM columns WHERE length(description) < 5").empty());
  EXPECT_EQ(
      pairs("SELECT unit, description FROM columns WHERE table_name = 'blows' AND column_name = 'energy'")[0].first,
      "J");
}

TEST_F(TablesPage, StatesUnitAndDescriptionAsTheDatabase) {
  Columns page = documented();
  life::Database database(file_.path(), life::Database::Use::kRead, 0);
  life::Database::Statement rows(database, "SELECT table_name, column_name, unit, description FROM columns");
  std::size_t compared = 0;
  while (rows.step()) {
    const std::string table = rows.text(0), column = rows.text(1);
    const bool of_message = (table == "turns" || table == "blows") && column != "turn" && column != "stamp_ns";
    if (of_message || (column == "run_id" && table != "runs")) continue;
    EXPECT_EQ((page[{table, column}]), std::make_pair(rows.text(2), rows.text(3))) << table << '.' << column;
    ++compared;
  }
  EXPECT_EQ(page.size(), compared) << "the page has columns that no table has";
}

/// {field: unit} of a file in msg/.
std::map<std::string, std::string> unitsOf(const std::filesystem::path& message) {
  std::map<std::string, std::string> units;
  std::ifstream file(message);
  const std::regex field(R"(\S*float64\S* (\w+)\s*(?:# \[([^\]]+)\] .+)?)");
  for (std::string line; std::getline(file, line);) {
    std::smatch found;
    if (std::regex_match(line, found, field)) units[found[1]] = found[2];
  }
  return units;
}

const std::filesystem::path kMessages = std::filesystem::path(HAMMER_LOADS_TEST_DATA) / "../../msg";

TEST(Messages, StateTheUnitOfEveryNumber) {
  std::size_t fields = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kMessages)) {
    for (const auto& [field, unit] : unitsOf(entry.path())) {
      EXPECT_NE(unit, "") << entry.path() << ' ' << field;
      ++fields;
    }
  }
  EXPECT_GT(fields, 100U);
}

TEST(ChannelUnit, IsThatOfTheMessagesField) {
  const auto of = [](const char* message) { return unitsOf(kMessages / message); };
  for (const char* field : {"force_x", "force_z", "torque_y"})
    EXPECT_EQ(life::unitOf(std::string("hull_wrench/") + field), of("HullLoads.msg").at(field)) << field;
  EXPECT_EQ(life::unitOf("joint_loads/arm_joint/total_torque"), of("JointLoad.msg").at("total_torque"));
  EXPECT_EQ(life::unitOf("joint_loads/arm_cylinder/force"), of("CylinderLoad.msg").at("force"));
  EXPECT_EQ(life::unitOf("section_loads/torque_tube/force_x"), "N") << "a section's name says nothing of the unit";
  EXPECT_EQ(life::unitOf("stress/toe"), "MPa");
  for (const char* field : {"amplitude", "impulse", "turn_impulse_x", "turn_impulse_z"})
    EXPECT_EQ(life::unitOf(std::string("pulse/") + field), of("Pulse.msg").at(field)) << field;
  for (const char* field : {"energy", "restitution"})
    EXPECT_EQ(life::unitOf(std::string("blow/") + field), of("Blow.msg").at(field)) << field;
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
