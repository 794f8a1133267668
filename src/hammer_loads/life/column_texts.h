/// Units and descriptions of the columns of a database, from the comments in its schema.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/life/database.h"

namespace hammer_loads::life {

/// A row of the table `columns`.
struct ColumnText {
  std::string table, column;
  std::string unit;  ///< "-" for a number without unit and for a text; "channel": that of the row's channel
  std::string description;
};

/// Rows for a schema with one column a line and a comment `-- [unit] description` behind each, in their order.
std::vector<ColumnText> columnTexts(const std::string& schema);

/// Schema of the table `columns` itself, in that form.
extern const char* const kColumnsTable;

void insert(const std::vector<ColumnText>& texts, Database& database);

}  // namespace hammer_loads::life
