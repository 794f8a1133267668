#include "hammer_loads/tables/table_writer.h"

#include "hammer_loads/life/database.h"

namespace hammer_loads {

TableWriter::TableWriter(const std::string& file, const std::vector<TableColumn>& turn,
                         const std::vector<TableColumn>& blow)
    : database_(file, life::Database::Use::kWrite, 0) {
  const std::string schema = beginTablesSql(turn, blow);
  database_.run(schema.c_str());
  insert(life::columnTexts(schema), database_);
}

TableWriter::Statement& TableWriter::insertInto(const std::string& table, std::size_t values) {
  const auto known = inserts_.find(table);
  if (known != inserts_.end()) return known->second;
  std::string sql = "INSERT INTO " + table + " VALUES(?";
  for (std::size_t i = 1; i < values; ++i) sql += ", ?";
  return inserts_.try_emplace(table, database_, (sql + ")").c_str()).first->second;
}

void TableWriter::addTurn(const std::string& table, std::int64_t run, std::int64_t stamp,
                          const std::vector<double>& values) {
  Statement& insert = insertInto(table, values.size() + 2);
  insert.reset();
  int place = 0;
  insert.bind(++place, run);
  insert.bind(++place, values.front());
  insert.bind(++place, stamp);
  for (std::size_t i = 1; i < values.size(); ++i) insert.bind(++place, values[i]);
  insert.step();
}

void TableWriter::finish() {
  inserts_.clear();
  database_.run("COMMIT");
}

}  // namespace hammer_loads
