/// Queries in SQL to the tables that process_bag --db writes.
#pragma once

#include <gtest/gtest.h>

#include "commands/bag_files.h"
#include "hammer_loads/life/database.h"

namespace hammer_loads::test {

class Tables : public BagFiles {
 protected:
  using Database = life::Database;
  /// Returns the first column of each row, with "NULL" for null values.
  std::vector<std::string> ask(const std::string& file, const std::string& sql) const {
    Database database(path(file), Database::Use::kRead, 0);
    std::vector<std::string> rows;
    Database::Statement query(database, sql.c_str());
    while (query.step()) rows.push_back(query.isNull(0) ? "NULL" : query.text(0));
    EXPECT_EQ(database.problem(), "") << sql;
    return rows;
  }
  /// Returns the first number of the first row with all digits.
  double number(const std::string& file, const std::string& sql) const {
    Database database(path(file), Database::Use::kRead, 0);
    Database::Statement query(database, sql.c_str());
    EXPECT_TRUE(query.step()) << sql << ": " << database.problem();
    return query.number(0);
  }
  Outcome tables(const std::string& bags, const std::string& file, const std::string& options = "") const {
    return run("--no-bag " + bags + " --db " + path(file) + " " + options);
  }
};

}  // namespace hammer_loads::test
