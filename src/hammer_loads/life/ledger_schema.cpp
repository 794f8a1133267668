#include "hammer_loads/life/ledger_schema.h"

#include <optional>

#include "hammer_loads/life/cycle_count.h"

namespace hammer_loads::life {
namespace {

constexpr std::int64_t kApplication = 0x484C4C31;  ///< "HLL1"
constexpr std::int64_t kLedgerVersion = 1;

// Integers of `least`, `classes` and so on belong to LoadGrid; `steps` and `low` to ClosedCycles. A day belongs to one
// run, so that each run can be taken out.
constexpr char kTables[] = R"(
CREATE TABLE epochs(
  epoch INTEGER PRIMARY KEY,                 -- [-] number of the epoch: one hammer, boom and grid
  machine TEXT NOT NULL,                     -- [-] digest of the machine
  equivalent_cycles_per_hour REAL NOT NULL   -- [1/h] rate of damage-equivalent ranges
);
CREATE TABLE channels(
  channel INTEGER PRIMARY KEY,               -- [-] number of the channel
  epoch INTEGER NOT NULL REFERENCES epochs,  -- [-] number of the epoch
  name TEXT NOT NULL,                        -- [-] topic/field, topic/name/field, or stress/NAME of a hot spot
  unit TEXT NOT NULL,                        -- [-] unit of the channel
  least REAL NOT NULL,                       -- [channel] lower end of the full scale
  greatest REAL NOT NULL,                    -- [channel] upper end of the full scale
  classes INTEGER NOT NULL,                  -- [-] number of classes of the full scale
  sn_knee_range REAL,                        -- [MPa] range at the knee of the S-N curve; NULL without a curve
  sn_knee_cycles REAL,                       -- [-] cycles at the knee
  sn_slope REAL,                             -- [-] slope above the knee range
  sn_slope_below REAL,                       -- [-] slope below the knee range
  mean_stress_sensitivity REAL,              -- [-] mean-stress sensitivity M of FKM; NULL: mean stress is not considered
  UNIQUE(epoch, name));
CREATE TABLE runs(
  run INTEGER PRIMARY KEY,                   -- [-] number of the run
  name TEXT NOT NULL UNIQUE,                 -- [-] first stamp and digest of the first samples
  epoch INTEGER NOT NULL REFERENCES epochs,  -- [-] number of the epoch
  pieces INTEGER NOT NULL,                   -- [-] number of pieces written
  parameters TEXT NOT NULL,                  -- [-] parameters of the sensors
  messages INTEGER NOT NULL                  -- [-] number of crank messages
);
CREATE TABLE days(
  day INTEGER PRIMARY KEY,                   -- [-] number of the day of a run
  epoch INTEGER NOT NULL REFERENCES epochs,  -- [-] number of the epoch
  run INTEGER NOT NULL REFERENCES runs,      -- [-] number of the run
  date TEXT NOT NULL,                        -- [-] date, UTC
  duration_ns INTEGER NOT NULL,              -- [ns] time between samples, gaps left out
  turns INTEGER NOT NULL                     -- [-] number of blows
);
CREATE INDEX days_of_run ON days(run);
CREATE TABLE tallies(
  channel INTEGER NOT NULL REFERENCES channels,  -- [-] number of the channel
  day INTEGER NOT NULL REFERENCES days,          -- [-] number of the day of a run
  counted INTEGER NOT NULL,                      -- [-] values counted
  skipped INTEGER NOT NULL,                      -- [-] values left out: not a number
  below INTEGER NOT NULL,                        -- [-] values below the full scale
  above INTEGER NOT NULL,                        -- [-] values above the full scale
  gaps INTEGER NOT NULL,                         -- [-] places where samples are missing
  deviations INTEGER NOT NULL,                   -- [-] number of values with a standard deviation
  deviation_sum INTEGER NOT NULL,                -- [-] sum of these standard deviations in 1/1024 of a class width
  least REAL,                                    -- [channel] least value
  greatest REAL,                                 -- [channel] greatest value
  range_square INTEGER NOT NULL,                 -- [-] sum of squares of the ranges of turns, in integers
  range_own INTEGER NOT NULL,                    -- [-] sum of their variances that are new in each turn
  range_common INTEGER NOT NULL,                 -- [-] sum of their parts that constants make
  PRIMARY KEY(channel, day)) WITHOUT ROWID;
CREATE TABLE cycles(
  channel INTEGER NOT NULL REFERENCES channels,  -- [-] number of the channel
  day INTEGER NOT NULL REFERENCES days,          -- [-] number of the day of a run
  steps INTEGER NOT NULL,                        -- [-] range in classes
  low INTEGER NOT NULL,                          -- [-] lower class
  count INTEGER NOT NULL,                        -- [-] number of these cycles
  PRIMARY KEY(channel, day, steps, low)) WITHOUT ROWID;
CREATE TABLE residues(
  channel INTEGER NOT NULL REFERENCES channels,  -- [-] number of the channel
  run INTEGER NOT NULL REFERENCES runs,          -- [-] number of the run
  place INTEGER NOT NULL,                        -- [-] place in time order
  class INTEGER NOT NULL,                        -- [-] class of the turning point
  PRIMARY KEY(channel, run, place)) WITHOUT ROWID;
CREATE TABLE marks(
  mark INTEGER NOT NULL,                         -- [-] digest of a sample, which recognises a recording counted before
  run INTEGER NOT NULL REFERENCES runs,          -- [-] number of the run
  PRIMARY KEY(mark, run)) WITHOUT ROWID;
)";

std::int64_t valueOf(Database& database, const char* sql) {
  Database::Statement statement(database, sql);
  return statement.step() ? statement.integer(0) : -1;
}

enum Column { kId, kName, kLeast, kGreatest, kClasses, kKneeRange, kKneeCycles, kSlope, kSlopeBelow, kSensitivity };

/// Values that a run writes into some columns of a table: SQL, in which $ is a column, and words.
struct Rule {
  const char* from;
  std::vector<const char*> columns;
  const char *sql, *words;
};

constexpr char kIsText[] = "typeof($) = 'text'";
// Two of them may be added without going beyond 64 bits, where SQLite goes on in floating point.
constexpr char kIsCount[] = "typeof($) = 'integer' AND $ BETWEEN 0 AND 4611686018427387904";
constexpr char kCount[] = "an integer in [0, 4611686018427387904]";

std::vector<const char*> tallyNames() {
  std::vector<const char*> names;
  for (const TallyColumn& column : kTallyColumns) names.push_back(column.name);
  return names;
}

const Rule kRules[] = {{"epochs", {"machine"}, kIsText, "a text"},
                       {"epochs",
                        {"equivalent_cycles_per_hour"},
                        "typeof($) IN ('integer', 'real') AND $ > 0 AND $ < 1e300",
                        "a finite number > 0"},
                       {"channels", {"name", "unit"}, kIsText, "a text"},
                       {"runs", {"name"}, kIsText, "a text"},
                       {"runs", {"pieces", "messages"}, kIsCount, kCount},
                       {"days", {"date"}, "typeof($) = 'text' AND date($) IS $", "a date YYYY-MM-DD"},
                       {"days", {"duration_ns", "turns"}, kIsCount, kCount},
                       {"tallies", tallyNames(), kIsCount, kCount},
                       {"tallies",
                        {"least", "greatest"},
                        "$ IS NULL OR (typeof($) IN ('integer', 'real') AND abs($) < 1e300)",
                        "a finite number or none"},
                       {"cycles JOIN channels USING(channel)",
                        {"low"},
                        "typeof($) = 'integer' AND $ BETWEEN 0 AND classes - 2",
                        "an integer in [0, classes - 2]"},
                       {"cycles JOIN channels USING(channel)",
                        {"steps"},
                        "typeof($) = 'integer' AND $ BETWEEN 1 AND classes - 1 - low",
                        "an integer in [1, classes - 1 - low]"},
                       {"cycles",
                        {"count"},
                        "typeof($) = 'integer' AND $ BETWEEN 1 AND 4611686018427387904",
                        "an integer in [1, 4611686018427387904]"},
                       {"residues JOIN channels USING(channel)",
                        {"class"},
                        "typeof($) = 'integer' AND $ BETWEEN 0 AND classes - 1",
                        "an integer in [0, classes - 1]"}};

/// A problem for the first value of the column that does not obey the rule.
void check(Database& database, const Rule& rule, const std::string& column) {
  std::string sql = rule.sql;
  for (std::size_t at = sql.find('$'); at != std::string::npos; at = sql.find('$')) sql.replace(at, 1, column);
  const std::string from = rule.from;
  Database::Statement wrong(database,
                            "SELECT quote(" + column + ") FROM " + from + " WHERE (" + sql + ") IS NOT TRUE LIMIT 1");
  if (wrong.step())
    database.fail("damaged: " + from.substr(0, from.find(' ')) + ": " + column + " " + wrong.text(0).substr(0, 60) +
                  ", must be " + rule.words);
}

}  // namespace

bool isLedger(Database& database) {
  const std::int64_t application = valueOf(database, "PRAGMA application_id");
  const std::int64_t version = valueOf(database, "PRAGMA user_version");
  const std::int64_t tables = valueOf(database, "SELECT count(*) FROM sqlite_master");
  if (!database.good() || (application == 0 && version == 0 && tables == 0)) return false;
  Database::Statement other(database,
                            "SELECT type, name FROM sqlite_master WHERE type IN ('view', 'trigger') OR "
                            "(type = 'table' AND (rootpage < 1 OR sql LIKE 'CREATE VIRTUAL%'))");
  if (other.step())
    database.fail(other.text(0) + " " + other.text(1) + ": must hold tables alone, as this package writes them");
  if (!database.good()) return false;
  if (application != kApplication) database.fail("is another database, no ledger");
  if (version != kLedgerVersion)
    database.fail("a ledger of version " + std::to_string(version) + ", must be " + std::to_string(kLedgerVersion));
  return true;
}

void checkLedger(Database& database) {
  for (const Rule& rule : kRules)
    for (const char* column : rule.columns) check(database, rule, column);
  Database::Statement epochs(database, "SELECT epoch FROM epochs");
  while (epochs.step()) channelsOf(database, epochs.integer(0));
}

void beginAsLedger(Database& database) {
  // A commit must outlast a power cut, the journal's removal included.
  database.run("PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON; BEGIN IMMEDIATE");
  if (isLedger(database)) return;
  const std::string tables = std::string(kTables) + kColumnsTable;
  database.run(tables + "PRAGMA application_id = " + std::to_string(kApplication) +
               "; PRAGMA user_version = " + std::to_string(kLedgerVersion));
  describeColumns(tables, database);
}

std::vector<CountedChannel> channelsOf(Database& database, std::int64_t epoch) {
  Database::Statement row(database,
                          "SELECT channel, name, least, greatest, classes, sn_knee_range, sn_knee_cycles, sn_slope, "
                          "sn_slope_below, mean_stress_sensitivity FROM channels WHERE epoch = ?1 ORDER BY channel",
                          epoch);
  std::vector<CountedChannel> channels;
  while (row.step()) {
    const Checked<LoadGrid> grid = LoadGrid::make(row.number(kLeast), row.number(kGreatest), row.integer(kClasses));
    Checked<SnCurve> curve;
    if (!row.isNull(kKneeRange))
      curve =
          SnCurve::make(row.number(kKneeRange), row.number(kKneeCycles), row.number(kSlope), row.number(kSlopeBelow));
    if (!grid.value || !curve.problems.empty()) {
      database.fail("damaged: channel " + row.text(kName) + " has no possible grid or curve");
      break;
    }
    std::optional<FkmMeanStress> mean;
    if (!row.isNull(kSensitivity)) mean = FkmMeanStress{row.number(kSensitivity)};
    channels.push_back({row.text(kName), *grid.value, {}, {}, curve.value, mean, row.integer(kId)});
  }
  return channels;
}

}  // namespace hammer_loads::life
