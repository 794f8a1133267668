/// A SQLite file: statements one after another, the first error kept; and the table that explains its columns. Nothing
/// throws.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>

#include "hammer_loads/util/constants.h"

struct sqlite3;
struct sqlite3_stmt;

namespace hammer_loads::life {

/// After an error every further call has no effect, so that a caller checks once, at the end.
class Database {
 public:
  enum class Use { kRead, kWrite };  ///< kWrite makes the file where there is none

  /// Waits up to `patience_ms` for others to release the file. A pathProblem() is its first error.
  Database(const std::string& path, Use use, int patience_ms);

  /// Reason why the path cannot be that of a database, one line; empty: it can. Does not open the file.
  static std::string pathProblem(const std::string& path, Use use);

  /// Runs statements without result.
  void run(const std::string& sql);

  /// One statement, to run many times with other values.
  class Statement {
   public:
    /// values: of ?1, ?2 ..., if the statement has any.
    template <typename... Values>
    Statement(Database& database, const std::string& sql, const Values&... values) : database_(database) {
      prepare(sql);
      bindAll(values...);
    }
    template <typename... Values>
    void run(const Values&... values) {
      bindAll(values...);
      while (step()) {
      }
    }
    /// One value after another, where their number is not known beforehand: reset(), bind() each place from 1, step().
    void reset();
    template <typename T, std::enable_if_t<std::is_integral_v<T>, int> = 0>
    void bind(int place, T value) {
      bindInteger(place, static_cast<std::int64_t>(value));
    }
    void bind(int place, double value);  ///< NULL for what is not finite
    void bind(int place, const std::string& value);
    template <typename T>
    void bind(int place, const std::optional<T>& value) {  ///< NULL for nothing
      value ? bind(place, *value) : bind(place, kNaN);
    }
    /// Next row of a query; false after the last one, and after an error.
    bool step();
    std::int64_t integer(int column) const;
    double number(int column) const;  ///< NaN for NULL
    bool isNull(int column) const;
    std::string text(int column) const;

   private:
    void prepare(const std::string& sql);
    void bindInteger(int place, std::int64_t value);
    struct Finalize {
      void operator()(sqlite3_stmt* statement) const;
    };
    template <typename... Values>
    void bindAll(const Values&... values) {
      reset();
      [[maybe_unused]] int place = 0;
      (bind(++place, values), ...);
    }
    Database& database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  };

  /// First error in one line, without the file's name; empty without an error.
  const std::string& problem() const { return problem_; }
  bool good() const { return problem_.empty(); }
  /// Reports an error found by the caller, in one line; the first error is kept.
  void fail(const std::string& problem);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  /// True for a result of success.
  bool check(int result);

  std::unique_ptr<sqlite3, Close> handle_;
  std::string problem_;
};

/// Schema of the table `columns`, which explains the columns of all tables.
extern const char* const kColumnsTable;

/// Fills the table `columns` by a schema with one column a line and a comment `-- [unit] description` behind each. The
/// unit is "-" for a number without unit and for a text, and "channel" for that of the row's channel.
void describeColumns(const std::string& schema, Database& database);

}  // namespace hammer_loads::life
