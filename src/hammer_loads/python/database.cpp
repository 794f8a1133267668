#include "hammer_loads/life/database.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "hammer_loads/python/tables.h"

namespace hammer_loads::python {
namespace {

constexpr std::int64_t kKinds[] = {0x484C5242, 0x484C4C31, 0x484C5246};  // process_bag --db, ledger, fleet
constexpr int kPatience = 5000;                                          // [ms] as of the command report

/// One column, as its values come: all whole numbers, numbers, or texts as soon as one is a text.
struct Column {
  std::string name;
  bool text{}, whole{true};
  std::vector<std::int64_t> integers;
  std::vector<double> numbers;
  std::vector<std::optional<std::string>> texts;
};

struct Table {
  std::string name;
  std::vector<Column> columns;
};

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

/// Why it is no SQLite file, as the command report says it; empty for one.
std::string fileProblem(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return std::string("cannot be read: ") + std::strerror(errno);
  if (!S_ISREG(status.st_mode)) return "is no regular file";
  std::array<char, 16> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::string("cannot be read: ") + std::strerror(errno);
  file.read(head.data(), head.size());
  if (!file || std::memcmp(head.data(), "SQLite format 3", head.size()) != 0) return "is no SQLite file";
  return {};
}

/// Names of the tables and, of one table, names and declared types of its columns.
using Names = std::vector<std::pair<std::string, std::string>>;
Names namesOf(life::Database& database, const std::string& sql, int name, int type) {
  Names names;
  life::Database::Statement statement(database, sql.c_str());
  while (statement.step()) names.emplace_back(statement.text(name), statement.text(type));
  return names;
}

Table readTable(life::Database& database, const std::string& name) {
  Table table{name, {}};
  std::string list;
  for (const auto& [column, type] : namesOf(database, "PRAGMA table_info(" + quoted(name) + ")", 1, 2)) {
    Column added;
    added.name = column;
    added.text = type.find("INT") == std::string::npos && type.find("REAL") == std::string::npos;
    added.whole = type.find("INT") != std::string::npos;
    table.columns.push_back(std::move(added));
    list += (list.empty() ? "" : ", ") + quoted(column);
  }
  if (table.columns.empty()) return table;
  life::Database::Statement rows(database, ("SELECT " + list + " FROM " + quoted(name)).c_str());
  while (rows.step()) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      Column& column = table.columns[c];
      const int place = static_cast<int>(c);
      const bool missing = rows.isNull(place);
      if (column.text) {
        column.texts.push_back(missing ? std::nullopt : std::make_optional(rows.text(place)));
        continue;
      }
      column.whole = column.whole && !missing;
      column.integers.push_back(rows.integer(place));
      column.numbers.push_back(rows.number(place));
    }
  }
  return table;
}

py::object arrayOf(const Column& column) {
  const auto count = static_cast<py::ssize_t>(column.numbers.size());
  if (column.text) {
    py::list texts;
    for (const auto& text : column.texts)
      texts.append(text ? py::object(py::reinterpret_steal<py::object>(
                              PyUnicode_DecodeUTF8(text->data(), static_cast<py::ssize_t>(text->size()), "replace")))
                        : py::object(py::none()));
    return py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "object");
  }
  if (column.whole) return py::array_t<std::int64_t>(count, column.integers.data());
  return py::array_t<double>(count, column.numbers.data());
}

/// All of one instant, or a problem.
std::vector<Table> readAll(const std::string& path, std::string& problem) {
  std::vector<Table> tables;
  problem = fileProblem(path);
  if (!problem.empty()) return tables;
  life::Database database(path, life::Database::Use::kRead, kPatience);
  database.run("BEGIN");
  std::int64_t kind = 0;
  {
    life::Database::Statement id(database, "PRAGMA application_id");
    if (id.step()) kind = id.integer(0);
  }
  if (std::find(std::begin(kKinds), std::end(kKinds), kind) == std::end(kKinds))
    database.fail("is another database (application_id " + std::to_string(kind) +
                  "), must be written by process_bag --db, --ledger or the fleet");
  const Names names = namesOf(
      database, "SELECT name, type FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%' ORDER BY name",
      0, 1);
  for (const auto& [name, type] : names) tables.push_back(readTable(database, name));
  problem = database.problem();
  return tables;
}

}  // namespace

py::dict readDatabase(const std::string& path) {
  std::string problem;
  std::vector<Table> tables;
  {
    const py::gil_scoped_release others_may_run;
    tables = readAll(path, problem);
  }
  if (!problem.empty()) raise({path + ": " + problem});
  py::dict result;
  for (const Table& table : tables) {
    py::dict columns;
    for (const Column& column : table.columns) columns[column.name.c_str()] = arrayOf(column);
    result[table.name.c_str()] = columns;
  }
  return result;
}

}  // namespace hammer_loads::python
