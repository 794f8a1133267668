/// Tables of process_bag's results (doc/tables.md) in a SQLite file, and the check whether a file is one.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"

namespace hammer_loads {

constexpr int kTablesApplication = 0x484C5242;  ///< "HLRB"
constexpr int kTablesVersion = 1;

/// A column that comes from a message's field.
struct TableColumn {
  std::string name;
  bool is_integer{};
  std::string unit, description;  ///< unit and description of the field's comment, "[unit] description"
};

/// Reason why an existing file must stay; empty: it is a file of these tables.
std::string whyTablesMustStay(const std::string& file);

/// Writes one transaction; the same rows give the same bytes. No function throws: problem() returns the first error,
/// after which all calls have no effect.
class TableWriter {
 public:
  /// The file must be empty. turn, blow: columns of the tables `turns` and `blows`, of which the first is `turn`.
  TableWriter(const std::string& file, const std::vector<TableColumn>& turn, const std::vector<TableColumn>& blow);

  /// Adds a row with the values of all columns, in their order, or of those that `table` lists behind its name. NULL
  /// is written for nothing and for a number that is not finite.
  template <typename... Values>
  void add(const std::string& table, const Values&... values) {
    insertInto(table, sizeof...(values)).run(values...);
  }
  /// Adds a row to `turns` or `blows`. stamp [ns]; values: of the message's columns, in their order.
  void addTurn(const std::string& table, std::int64_t run, std::int64_t stamp, const std::vector<double>& values);
  /// Ends the transaction: all of the file is written.
  void finish();

  /// First error in one line, without the file's name; empty without an error.
  const std::string& problem() const { return database_.problem(); }

 private:
  using Statement = life::Database::Statement;
  Statement& insertInto(const std::string& table, std::size_t values);

  life::Database database_;
  std::map<std::string, Statement> inserts_;  ///< by table
};

}  // namespace hammer_loads
