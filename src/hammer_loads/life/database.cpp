#include "hammer_loads/life/database.h"

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <regex>
#include <sstream>

#include "hammer_loads/util/number_text.h"

namespace hammer_loads::life {

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }
void Database::Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

std::string Database::pathProblem(const std::string& path, Use use) {
  struct stat found {};
  const bool exists = stat(path.c_str(), &found) == 0, to_write = use == Use::kWrite;
  if (exists && !S_ISREG(found.st_mode)) return "is no regular file";
  if (!to_write) return exists ? "" : std::string("cannot be read: ") + std::strerror(errno);
  // SQLite finds what a broken commit left by the file's name.
  if (exists && found.st_nlink > 1) return "has several names (hard links), must have one";
  const std::string place = exists ? path : std::filesystem::absolute(path).parent_path().string();
  if (access(place.c_str(), exists ? W_OK : W_OK | X_OK) == 0) return {};
  return (exists ? "cannot be written: " : "cannot be made: ") + std::string(std::strerror(errno));
}

Database::Database(const std::string& path, Use use, int patience_ms) {
  fail(pathProblem(path, use));
  if (!good()) return;
  const int flags = use == Use::kWrite ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READWRITE;
  sqlite3* handle = nullptr;
  const int result = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (!check(result)) return;
  check(sqlite3_busy_timeout(handle, patience_ms));
}

void Database::fail(const std::string& problem) {
  if (problem_.empty()) problem_ = onOneLine(problem);  // it may quote a damaged file's bytes
}

bool Database::check(int result) {
  if (result == SQLITE_OK || result == SQLITE_ROW || result == SQLITE_DONE) return true;
  const int error = errno;  // sqlite3_system_errno() does not know that of a COMMIT
  std::string reason = handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(result);
  if (error != 0 && (result & 0xFF) == SQLITE_IOERR) reason += std::string(": ") + std::strerror(error);
  fail(reason);
  return false;
}

void Database::run(const std::string& sql) {
  if (good()) check(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

void Database::Statement::prepare(const std::string& sql) {
  if (!database_.good()) return;
  sqlite3_stmt* statement = nullptr;
  database_.check(sqlite3_prepare_v2(database_.handle_.get(), sql.c_str(), -1, &statement, nullptr));
  statement_.reset(statement);
}

bool Database::Statement::step() {
  if (!database_.good()) return false;
  const int result = sqlite3_step(statement_.get());
  return database_.check(result) && result == SQLITE_ROW;
}

void Database::Statement::reset() {
  if (statement_) sqlite3_reset(statement_.get());
}

void Database::Statement::bindInteger(int place, std::int64_t value) {
  if (database_.good()) database_.check(sqlite3_bind_int64(statement_.get(), place, value));
}

void Database::Statement::bind(int place, double value) {
  if (!database_.good()) return;
  database_.check(std::isfinite(value) ? sqlite3_bind_double(statement_.get(), place, value)
                                       : sqlite3_bind_null(statement_.get(), place));
}

void Database::Statement::bind(int place, const std::string& value) {
  if (!database_.good()) return;
  database_.check(
      sqlite3_bind_text64(statement_.get(), place, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

std::int64_t Database::Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

bool Database::Statement::isNull(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

double Database::Statement::number(int column) const {
  return isNull(column) ? kNaN : sqlite3_column_double(statement_.get(), column);
}

std::string Database::Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text == nullptr ? std::string{}
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

const char* const kColumnsTable = R"(
CREATE TABLE columns(
  table_name TEXT,   -- [-] name of a table
  column_name TEXT,  -- [-] name of a column of it
  unit TEXT,         -- [-] unit of its numbers; channel: that of the channel in the same row
  description TEXT,  -- [-] meaning of its values
  PRIMARY KEY(table_name, column_name)) WITHOUT ROWID;
)";

void describeColumns(const std::string& schema, Database& database) {
  static const std::regex begins(R"(CREATE TABLE (\w+)\()"), column(R"re(\s+(\w+) .*-- \[([^\]]+)\] (.+))re");
  Database::Statement insert(database, "INSERT INTO columns VALUES(?1, ?2, ?3, ?4)");
  std::istringstream lines(schema);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_search(line, found, begins)) table = found[1];
    if (std::regex_match(line, found, column)) insert.run(table, found[1].str(), found[2].str(), found[3].str());
  }
}

}  // namespace hammer_loads::life
