#include "hammer_loads/life/column_texts.h"

#include <regex>
#include <sstream>

namespace hammer_loads::life {

const char* const kColumnsTable = R"(
CREATE TABLE columns(
  table_name TEXT,   -- [-] name of a table
  column_name TEXT,  -- [-] name of a column of it
  unit TEXT,         -- [-] unit of its numbers; channel: that of the channel in the same row
  description TEXT,  -- [-] meaning of its values
  PRIMARY KEY(table_name, column_name)) WITHOUT ROWID;
)";

std::vector<ColumnText> columnTexts(const std::string& schema) {
  static const std::regex begins(R"(CREATE TABLE (\w+)\()"), column(R"re(\s+(\w+) .*-- \[([^\]]+)\] (.+))re");
  std::vector<ColumnText> texts;
  std::istringstream lines(schema);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_search(line, found, begins)) table = found[1];
    if (std::regex_match(line, found, column)) texts.push_back({table, found[1], found[2], found[3]});
  }
  return texts;
}

void insert(const std::vector<ColumnText>& texts, Database& database) {
  Database::Statement statement(database, "INSERT INTO columns VALUES(?1, ?2, ?3, ?4)");
  for (const ColumnText& text : texts) statement.run(text.table, text.column, text.unit, text.description);
}

}  // namespace hammer_loads::life
