#include "hammer_loads/life/ledger_schema.h"

#include <string>

namespace hammer_loads::life {
namespace {

constexpr std::int64_t kApplication = 0x484C4C31;  ///< "HLL1"

// One step per version. Integers of `least`, `classes` and so on belong to LoadGrid; `steps` and `low` to ClosedCycles.
// Version 1: residues with open = 1 are of the run at work, with 0 joined of all that ended.
constexpr const char* kUpgrades[kLedgerVersion] = {
    R"(
CREATE TABLE epochs(
  epoch INTEGER PRIMARY KEY, machine TEXT NOT NULL, equivalent_cycles_per_hour REAL NOT NULL);
CREATE TABLE channels(
  channel INTEGER PRIMARY KEY, epoch INTEGER NOT NULL REFERENCES epochs, name TEXT NOT NULL,
  least REAL NOT NULL, greatest REAL NOT NULL, classes INTEGER NOT NULL,
  sn_knee_range_MPa REAL, sn_knee_cycles REAL, sn_slope REAL, sn_slope_below REAL, mean_stress_sensitivity REAL,
  UNIQUE(epoch, name));
CREATE TABLE runs(
  run INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, epoch INTEGER NOT NULL REFERENCES epochs,
  pieces INTEGER NOT NULL, ended INTEGER NOT NULL);
CREATE TABLE days(
  day INTEGER PRIMARY KEY, epoch INTEGER NOT NULL REFERENCES epochs, date TEXT NOT NULL,
  duration_ns INTEGER NOT NULL, turns INTEGER NOT NULL);
CREATE TABLE tallies(
  channel INTEGER NOT NULL REFERENCES channels, day INTEGER NOT NULL REFERENCES days,
  counted INTEGER NOT NULL, skipped INTEGER NOT NULL, below INTEGER NOT NULL, above INTEGER NOT NULL,
  gaps INTEGER NOT NULL, deviations INTEGER NOT NULL, deviation_sum INTEGER NOT NULL, least REAL, greatest REAL,
  PRIMARY KEY(channel, day)) WITHOUT ROWID;
CREATE TABLE cycles(
  channel INTEGER NOT NULL REFERENCES channels, day INTEGER NOT NULL REFERENCES days,
  steps INTEGER NOT NULL, low INTEGER NOT NULL, count INTEGER NOT NULL,
  PRIMARY KEY(channel, day, steps, low)) WITHOUT ROWID;
CREATE TABLE residues(
  channel INTEGER NOT NULL REFERENCES channels, open INTEGER NOT NULL, place INTEGER NOT NULL, class INTEGER NOT NULL,
  PRIMARY KEY(channel, open, place)) WITHOUT ROWID;
)",
    // Runs apart, so that each can be taken out or replaced. What a ledger
    // of version 1 has stays together, with the first run of its epoch.
    R"(
ALTER TABLE runs ADD COLUMN apart INTEGER NOT NULL DEFAULT 1;
ALTER TABLE runs ADD COLUMN parameters TEXT NOT NULL DEFAULT '';
ALTER TABLE runs ADD COLUMN messages INTEGER NOT NULL DEFAULT 0;
UPDATE runs SET apart = 0, ended = 1;
ALTER TABLE days ADD COLUMN run INTEGER REFERENCES runs;
UPDATE days SET run = (SELECT min(run) FROM runs WHERE runs.epoch = days.epoch);
CREATE TABLE residues_by_run(
  channel INTEGER NOT NULL REFERENCES channels, run INTEGER NOT NULL REFERENCES runs, place INTEGER NOT NULL,
  class INTEGER NOT NULL, PRIMARY KEY(channel, run, place)) WITHOUT ROWID;
INSERT INTO residues_by_run SELECT r.channel,
  (SELECT CASE r.open WHEN 1 THEN max(run) ELSE min(run) END FROM runs WHERE runs.epoch = c.epoch), r.place, r.class
  FROM residues r JOIN channels c USING(channel);
DROP TABLE residues;
ALTER TABLE residues_by_run RENAME TO residues;
CREATE TABLE marks(
  mark INTEGER NOT NULL, run INTEGER NOT NULL REFERENCES runs, PRIMARY KEY(mark, run)) WITHOUT ROWID;
CREATE INDEX days_of_run ON days(run);
)",
    // Ranges of turns and their deviations; 0: not known apart.
    R"(
ALTER TABLE tallies ADD COLUMN range_square INTEGER NOT NULL DEFAULT 0;
ALTER TABLE tallies ADD COLUMN range_own INTEGER NOT NULL DEFAULT 0;
ALTER TABLE tallies ADD COLUMN range_common INTEGER NOT NULL DEFAULT 0;
)"};

/// A ledger of version 1 as one of version 2, for reading: the file stays as it is.
constexpr char kReadVersion1[] = R"(
CREATE TEMP VIEW days AS SELECT day, epoch, date, duration_ns, turns,
  (SELECT min(run) FROM main.runs r WHERE r.epoch = d.epoch) AS run FROM main.days d;
CREATE TEMP VIEW residues AS SELECT r.channel, place, class,
  (SELECT CASE r.open WHEN 1 THEN max(run) ELSE min(run) END FROM main.runs WHERE runs.epoch = c.epoch) AS run
  FROM main.residues r JOIN main.channels c USING(channel);
CREATE TEMP VIEW runs AS SELECT run, name, epoch, pieces, ended, 0 AS apart, '' AS parameters, 0 AS messages
  FROM main.runs;
)";

/// One of version 1 or 2 as one of version 3.
constexpr char kReadVersion2[] = R"(
CREATE TEMP VIEW tallies AS SELECT *, 0 AS range_square, 0 AS range_own, 0 AS range_common FROM main.tallies;
)";

std::int64_t valueOf(Database& database, const char* sql) {
  Database::Statement statement(database, sql);
  return statement.step() ? statement.integer(0) : -1;
}

/// Version of the ledger; 0 for an empty database. A problem for anything else.
std::int64_t versionOf(Database& database) {
  const std::int64_t application = valueOf(database, "PRAGMA application_id");
  const std::int64_t version = valueOf(database, "PRAGMA user_version");
  const std::int64_t tables = valueOf(database, "SELECT count(*) FROM sqlite_master");
  if (!database.good()) return 0;
  if (application == 0 && version == 0 && tables == 0) return 0;
  if (application != kApplication) database.fail("is another database, no ledger");
  if (version > kLedgerVersion || version < 1)
    database.fail("a ledger of version " + std::to_string(version) + ", must be at most " +
                  std::to_string(kLedgerVersion));
  return version;
}

}  // namespace

void beginAsLedger(Database& database) {
  // A commit must outlast a power cut, the journal's removal included.
  database.run("PRAGMA synchronous = EXTRA; PRAGMA foreign_keys = ON; BEGIN IMMEDIATE");
  std::int64_t version = versionOf(database);
  if (!database.good() || version == kLedgerVersion) return;
  for (; version < kLedgerVersion; ++version) database.run(kUpgrades[version]);
  database.run(("PRAGMA application_id = " + std::to_string(kApplication)).c_str());
  database.run(("PRAGMA user_version = " + std::to_string(kLedgerVersion)).c_str());
}

void beginReading(Database& database) {
  database.run("BEGIN");
  const std::int64_t version = versionOf(database);
  if (version == 0) database.fail("holds no ledger");
  if (version == 1) database.run(kReadVersion1);
  if (version <= 2) database.run(kReadVersion2);
}

}  // namespace hammer_loads::life
