/// Tables of process_bag's results (doc/tables.md), and the check whether a file is one.
#pragma once

#include <string>
#include <vector>

namespace hammer_loads {

constexpr int kTablesApplication = 0x484C5242;  ///< "HLRB"
constexpr int kTablesVersion = 1;

/// A column that comes from a message's field.
struct TableColumn {
  std::string name;
  bool is_integer{};
  std::string unit, description;  ///< unit and description of the field's comment, "[unit] description"
};

/// Everything up to the first row, with a comment for each column (life::columnTexts): one transaction is begun. The
/// same rows give the same bytes.
std::string beginTablesSql(const std::vector<TableColumn>& turn, const std::vector<TableColumn>& blow);

/// Reason why an existing file must stay; empty: it is a file of these tables.
std::string whyTablesMustStay(const std::string& file);

}  // namespace hammer_loads
