#include "hammer_loads/life/ledger_run.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {

/// A run as the ledger has it.
struct RunRow {
  std::int64_t run{}, epoch{};
  std::int64_t pieces{};  ///< commits of its writer
  std::string name;
  std::string parameters;    ///< parameters as in RunId
  std::uint64_t messages{};  ///< messages as in LifePiece, of all its pieces
};

namespace {

constexpr int kBatchPatience = 60000;  // [ms]; others hold the ledger for a transaction

bool isEmpty(const LifePiece& piece) {
  for (const CycleCount& count : piece.counts) {
    if (count.tally.counted + count.tally.skipped + count.tally.gaps > 0) return false;
  }
  return piece.duration == 0 && piece.turns == 0;
}

std::int64_t lastId(Database& database) {
  Database::Statement statement(database, "SELECT last_insert_rowid()");
  return statement.step() ? statement.integer(0) : 0;
}

/// Integers for SQL's json_each().
template <typename Integers>
std::string jsonOf(const Integers& integers) {
  std::string json;
  for (const auto integer : integers) json += (json.empty() ? "[" : ",") + std::to_string(integer);
  return json.empty() ? "[]" : json + "]";
}

/// Returns true if the epoch has the machine and the grids.
bool isOf(Database& database, std::int64_t epoch, const LedgerMachine& machine) {
  Database::Statement row(database, "SELECT machine FROM epochs WHERE epoch = ?1", epoch);
  if (!row.step() || row.text(0) != machine.identity) return false;
  const std::vector<CountedChannel> channels = channelsOf(database, epoch);
  return std::equal(
      channels.begin(), channels.end(), machine.channels.begin(), machine.channels.end(),
      [](const CountedChannel& a, const CountedChannel& b) { return a.name == b.name && a.grid == b.grid; });
}

/// Writes what judges the counts of an epoch, which may be new. Returns its number.
std::int64_t setMachine(Database& database, std::optional<std::int64_t> epoch, const LedgerMachine& machine) {
  Database::Statement(database,
                      "INSERT INTO epochs VALUES(?1, ?2, ?3) ON CONFLICT(epoch) DO UPDATE SET "
                      "equivalent_cycles_per_hour = excluded.equivalent_cycles_per_hour")
      .run(epoch, machine.identity, machine.equivalent_cycles_per_hour);
  const std::int64_t id = epoch ? *epoch : lastId(database);
  Database::Statement channel(
      database,
      "INSERT INTO channels VALUES(NULL, ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11) ON CONFLICT(epoch, name) DO "
      "UPDATE SET sn_knee_range = excluded.sn_knee_range, sn_knee_cycles = excluded.sn_knee_cycles, sn_slope = "
      "excluded.sn_slope, sn_slope_below = excluded.sn_slope_below, "
      "mean_stress_sensitivity = excluded.mean_stress_sensitivity");
  for (const CountedChannel& c : machine.channels) {
    const auto of = [&](double (SnCurve::*figure)() const) {
      return c.curve ? std::make_optional(((*c.curve).*figure)()) : std::nullopt;
    };
    channel.run(id, c.name, unitOf(c.name), c.grid.least(), c.grid.greatest(), c.grid.classes(),
                of(&SnCurve::kneeRange), of(&SnCurve::kneeCycles), of(&SnCurve::slope), of(&SnCurve::slopeBelow),
                c.mean_stress ? std::make_optional(c.mean_stress->sensitivity) : std::nullopt);
  }
  return id;
}

/// The run's latest day; a new one where the date is another, earlier ones too: a clock that runs back reorders
/// nothing.
std::int64_t dayFor(Database& database, const RunRow& run, std::int64_t days_since_1970) {
  constexpr std::int64_t kSecondsPerDay = 86400;
  Database::Statement(database,
                      "INSERT INTO days(epoch, date, duration_ns, turns, run) SELECT ?2, date(?3, 'unixepoch'), 0, 0, "
                      "?1 WHERE date(?3, 'unixepoch') IS NOT "
                      "(SELECT date FROM days WHERE run = ?1 ORDER BY day DESC LIMIT 1)")
      .run(run.run, run.epoch, days_since_1970 * kSecondsPerDay);
  Database::Statement latest(database, "SELECT max(day) FROM days WHERE run = ?1", run.run);
  return latest.step() ? latest.integer(0) : 0;
}

void addCycles(Database& database, std::int64_t channel, std::int64_t day, const std::vector<ClosedCycles>& closed) {
  Database::Statement add(
      database,
      "INSERT INTO cycles VALUES(?1, ?2, ?3, ?4, ?5) ON CONFLICT(channel, day, steps, low) DO UPDATE "
      "SET count = count + excluded.count");
  for (const ClosedCycles& c : closed) add.run(channel, day, c.steps, c.low, c.count);
}

void addTally(Database& database, std::int64_t channel, std::int64_t day, const CycleCount& count) {
  std::string columns, values, sums;
  for (const TallyColumn& column : kTallyColumns) {
    const std::string name = column.name;
    columns += ", " + name;
    values += ", " + std::to_string(count.tally.*column.number);
    sums += ", " + name + " = " + name + " + excluded." + name;
  }
  Database::Statement(
      database, "INSERT INTO tallies(channel, day, least, greatest" + columns + ") VALUES(?1, ?2, ?3, ?4" + values +
                    ") ON CONFLICT(channel, day) DO UPDATE SET "
                    "least = coalesce(min(least, excluded.least), least, excluded.least), "
                    "greatest = coalesce(max(greatest, excluded.greatest), greatest, excluded.greatest)" +
                    sums)
      .run(channel, day, count.extremes.least, count.extremes.greatest);
}

void setResidue(Database& database, std::int64_t channel, std::int64_t run, const std::vector<std::uint32_t>& residue) {
  Database::Statement(database, "DELETE FROM residues WHERE channel = ?1 AND run = ?2").run(channel, run);
  Database::Statement(database, "INSERT INTO residues SELECT ?1, ?2, key, value FROM json_each(?3)")
      .run(channel, run, jsonOf(residue));
}

void emptyRun(Database& database, const RunRow& run) {
  for (const char* sql :
       {"DELETE FROM cycles WHERE day IN (SELECT day FROM days WHERE run = ?1)",
        "DELETE FROM tallies WHERE day IN (SELECT day FROM days WHERE run = ?1)", "DELETE FROM days WHERE run = ?1",
        "DELETE FROM residues WHERE run = ?1", "DELETE FROM marks WHERE run = ?1", "DELETE FROM runs WHERE run = ?1"})
    Database::Statement(database, sql).run(run.run);
}

void removeUnusedEpochs(Database& database) {
  database.run(
      "DELETE FROM channels WHERE epoch NOT IN (SELECT epoch FROM runs); "
      "DELETE FROM epochs WHERE epoch NOT IN (SELECT epoch FROM runs)");
}

/// Runs that have the name, or samples that have one of these marks and the same machine; in their order.
std::vector<RunRow> runsLike(Database& database, const std::string& name, const LedgerMachine& machine = {},
                             const std::vector<std::int64_t>& marks = {}) {
  Database::Statement rows(database,
                           "SELECT run, epoch, pieces, name, parameters, messages FROM runs WHERE name = ?1 OR "
                           "(run IN (SELECT run FROM marks WHERE mark IN (SELECT value FROM json_each(?3))) AND "
                           "epoch IN (SELECT epoch FROM epochs WHERE machine = ?2)) ORDER BY run",
                           name, machine.identity, jsonOf(marks));
  std::vector<RunRow> runs;
  while (rows.step())
    runs.push_back({rows.integer(0), rows.integer(1), rows.integer(2), rows.text(3), rows.text(4),
                    static_cast<std::uint64_t>(rows.integer(5))});
  return runs;
}

/// Returns true if all marks of the run are among these. Reads the marks of every run.
bool isCovered(Database& database, const RunRow& run, const std::vector<std::int64_t>& marks) {
  Database::Statement other(
      database, "SELECT 1 FROM marks WHERE run = ?1 AND mark NOT IN (SELECT value FROM json_each(?2)) LIMIT 1", run.run,
      jsonOf(marks));
  return !other.step();
}

/// Removes the `replaced` runs and begins the run: at the place of the first of them if its epoch has the same machine
/// and grids, otherwise at the end, in a new epoch if the machine differs from the latest.
RunRow beginRun(Database& database, const LedgerMachine& machine, const RunId& id,
                const std::vector<RunRow>& replaced) {
  for (const RunRow& run : replaced) emptyRun(database, run);
  std::optional<std::int64_t> place, epoch;
  if (!replaced.empty() && isOf(database, replaced.front().epoch, machine)) {
    place = replaced.front().run;
    epoch = replaced.front().epoch;
  } else {
    removeUnusedEpochs(database);
    Database::Statement latest(database, "SELECT max(epoch) FROM epochs");
    if (latest.step() && isOf(database, latest.integer(0), machine)) epoch = latest.integer(0);
  }
  RunRow row;
  row.epoch = setMachine(database, epoch, machine);
  Database::Statement(database, "INSERT INTO runs VALUES(?1, ?2, ?3, 0, ?4, 0)")
      .run(place, id.name, row.epoch, id.parameters);
  row.run = lastId(database);
  removeUnusedEpochs(database);
  return row;
}

/// Removes a run, and its epoch if that has no other runs.
void removeRun(Database& database, const RunRow& run) {
  emptyRun(database, run);
  removeUnusedEpochs(database);
}

/// Adds counts of one day; the residue replaces the run's earlier one.
void addPiece(Database& database, const RunRow& run, const LifePiece& piece) {
  const std::vector<CountedChannel> channels = channelsOf(database, run.epoch);
  if (!database.good()) return;
  if (channels.size() != piece.counts.size()) return database.fail("damaged: channels of an epoch are missing");
  const std::int64_t day = dayFor(database, run, dayOf(piece.stamp));
  Database::Statement(database, "UPDATE days SET duration_ns = duration_ns + ?2, turns = turns + ?3 WHERE day = ?1")
      .run(day, piece.duration, piece.turns);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    addCycles(database, channels[i].id, day, piece.counts[i].closed);
    addTally(database, channels[i].id, day, piece.counts[i]);
    setResidue(database, channels[i].id, run.run, piece.counts[i].residue);
  }
}

/// The run's row after a commit, and what is new of its marks.
void setRun(Database& database, const RunRow& run, std::int64_t pieces, std::uint64_t messages,
            const std::vector<std::int64_t>& marks) {
  Database::Statement(database, "UPDATE runs SET pieces = ?2, messages = ?3 WHERE run = ?1")
      .run(run.run, pieces, messages);
  Database::Statement(database, "INSERT OR IGNORE INTO marks SELECT value, ?1 FROM json_each(?2)")
      .run(run.run, jsonOf(marks));
}

/// Reason to refuse a running run, as another one now has its samples.
std::string newlyShared(const RunRow& own, const std::vector<RunRow>& like) {
  for (const RunRow& other : like) {
    if (other.run != own.run) return "has samples of run " + other.name + ", which is in it already: not counted twice";
  }
  return {};
}

}  // namespace

void mergeDays(std::vector<LifePiece>& pieces, std::size_t from) {
  for (std::size_t i = pieces.size(); i > from + 1; --i) {
    LifePiece& before = pieces[i - 2];
    if (dayOf(before.stamp) != dayOf(pieces[i - 1].stamp)) continue;
    before.advance(pieces[i - 1]);
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i - 1));
  }
}

LedgerRun::LedgerRun(std::string path, LedgerMachine machine, RunId run)
    : path_(std::move(path)), machine_(std::move(machine)), id_(std::move(run)) {}

void LedgerRun::keep(LifePiece piece) {
  messages_ += piece.messages;
  marks_.insert(marks_.end(), piece.marks.begin(), piece.marks.end());
  piece.marks.clear();
  if (!isEmpty(piece)) waiting_.push_back(std::move(piece));
  mergeDays(waiting_, failed_ ? failed_->pieces : 0);
}

/// Reason to refuse the run, in view of the runs that have its samples.
std::string LedgerRun::judge(Database& database, const std::vector<RunRow>& like, bool end, bool replace) {
  for (const RunRow& row : like) {
    const std::string sizes = std::to_string(messages_) + " of its " + std::to_string(row.messages) + " samples";
    if (replace && messages_ >= row.messages) continue;
    if (replace)
      return "cannot replace run " + row.name + ": holds " + sizes + "; life --remove takes that one out first";
    const bool other = !id_.parameters.empty() && !row.parameters.empty() && id_.parameters != row.parameters;
    if (other && row.name == id_.name)
      return "is in it already with other sensor parameters; process_bag --replace-run puts this one in its place";
    if (end && !other && messages_ > row.messages && isCovered(database, row, marks_)) continue;
    known_ = row.name == id_.name;
    if (known_) return "is in it already, not counted again";
    return "has samples of run " + row.name +
           ", which is in it already; a part of a recording counts with all its parts in one call, and "
           "process_bag --replace-run puts a whole one in its place";
  }
  return {};
}

bool LedgerRun::Written::isThat(const RunRow& row) const {
  return commits > 0 && row.pieces == commits && row.messages == messages;
}

void LedgerRun::note(const Written& commit) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(commit.pieces));
  marks_.erase(marks_.begin(), marks_.begin() + static_cast<std::ptrdiff_t>(commit.marks));
  written_ = commit;
}

/// Returns true if the ledger has the run as this object left it. A commit that reported an error may be in the file
/// all the same; the row then has the values which that commit would have written.
bool LedgerRun::isOurs(const std::vector<RunRow>& rows) {
  const std::optional<Written> failed = std::exchange(failed_, std::nullopt);
  if (!rows.empty() && failed && failed->isThat(rows.front())) note(*failed);
  if (!rows.empty() && written_.isThat(rows.front()) && rows.front().parameters == id_.parameters) return true;
  // The first piece, or the written pieces were removed: the run has only the pieces from here on.
  messages_ -= written_.messages;
  written_ = {};
  return false;
}

bool LedgerRun::put(Database& database, bool end, bool replace) {
  const std::vector<RunRow> rows = runsLike(database, id_.name);
  if (!database.good()) return true;
  const bool ours = isOurs(rows);
  const std::vector<RunRow> like = runsLike(database, id_.name, machine_, marks_);
  known_ = false;
  refusal_ = contradiction_;
  if (refusal_.empty()) {
    const std::string reason = ours ? newlyShared(rows.front(), like) : judge(database, like, end, replace);
    if (!reason.empty()) refusal_ = "run " + id_.name + ": " + reason;
  }
  if (!database.good()) {
    refusal_.clear();  // not known yet
    return true;
  }
  if (refused() && ours) removeRun(database, rows.front());
  if (refused()) return false;
  mergeDays(waiting_);
  const RunRow row = ours ? rows.front() : beginRun(database, machine_, id_, like);
  for (const LifePiece& piece : waiting_) addPiece(database, row, piece);
  setRun(database, row, written_.commits + 1, messages_, marks_);
  return true;
}

std::optional<std::string> LedgerRun::write(bool end) {
  const auto problem = [&](const std::string& what) { return std::make_optional(path_ + ": " + what); };
  if (ended_) return refused() ? problem(refusal_) : std::nullopt;
  if (!end && refused())
    return problem(refusal_);  // the pieces are kept: at its end the run may have more than the ledger
  if (waiting_.empty() && !end && contradiction_.empty()) return std::nullopt;

  Database database(path_, Database::Use::kWrite, kPatience);
  beginAsLedger(database);
  if (written_.commits == 0) checkLedger(database);
  const bool taken = put(database, end, false);
  const Written commit{written_.commits + 1, waiting_.size(), marks_.size(), messages_};
  if (database.good() && taken) failed_ = commit;  // unless it succeeds
  database.run("COMMIT");
  if (!database.good()) return problem(database.problem());
  failed_.reset();
  ended_ = end;
  if (taken) note(commit);
  if (end) waiting_.clear();
  return taken ? std::nullopt : problem(refusal_);
}

std::string ledgerProblem(const std::string& path, int patience) {
  std::string problem = Database::pathProblem(path, Database::Use::kWrite);
  std::error_code error;
  if (problem.empty() && std::filesystem::exists(path, error)) {
    Database database(path, Database::Use::kRead, patience);
    isLedger(database);
    problem = database.problem();
  }
  return problem.empty() ? problem : path + ": " + problem;
}

std::optional<std::string> removeFromLedger(const std::string& path, const std::string& name) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return path + ": does not exist";
  Database database(path, Database::Use::kWrite, LedgerRun::kPatience);
  beginAsLedger(database);
  const std::vector<RunRow> rows = runsLike(database, name);
  if (rows.empty()) database.fail("has no run " + name + "; --runs lists them");
  if (database.good()) removeRun(database, rows.front());
  database.run("COMMIT");
  if (!database.good()) return path + ": " + database.problem();
  return std::nullopt;
}

std::string LedgerBatch::check() const { return ledgerProblem(path_, kBatchPatience); }

std::string LedgerBatch::write(std::vector<std::string>& known) {
  for (const LedgerRun& run : runs_)  // before a ledger is made
    if (!run.contradiction().empty()) return path_ + ": " + run.contradiction();
  if (std::string problem = check(); !problem.empty()) return problem;
  database_.emplace(path_, Database::Use::kWrite, kBatchPatience);
  beginAsLedger(*database_);
  checkLedger(*database_);
  std::string refused;
  for (LedgerRun& run : runs_) {
    if (run.put(*database_, true, replace_)) continue;
    if (run.known()) known.push_back(path_ + ": " + run.refusal());
    if (!run.known() && refused.empty()) refused = path_ + ": " + run.refusal();
  }
  runs_.clear();
  return database_->good() ? refused : path_ + ": " + database_->problem();
}

std::string LedgerBatch::commit() {
  if (!database_) return {};
  database_->run("COMMIT");
  const std::string problem = database_->good() ? "" : path_ + ": " + database_->problem();
  database_.reset();
  return problem;
}

}  // namespace hammer_loads::life
