#include "hammer_loads/life/ledger_run.h"

#include <filesystem>
#include <utility>

#include "hammer_loads/life/ledger_schema.h"

namespace hammer_loads::life {
namespace {

bool isEmpty(const LifePiece& piece) {
  for (const CycleCount& count : piece.counts) {
    if (count.tally.counted + count.tally.skipped + count.tally.gaps > 0) return false;
  }
  return piece.duration == 0 && piece.turns == 0;
}

constexpr int kBatchPatience = 60000;  // [ms]; others hold the ledger for a transaction

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

std::optional<std::string> LedgerRun::add(std::optional<LifePiece> piece) {
  if (piece) keep(*std::move(piece));
  return write(false);
}

std::optional<std::string> LedgerRun::end(std::optional<LifePiece> last) {
  if (last) keep(*std::move(last));
  return write(true);
}

std::string LedgerRun::contradiction() const {
  return id_.refusal.empty() ? "" : "run " + id_.name + ": is not counted: " + id_.refusal;
}

std::vector<std::int64_t> LedgerRun::newMarks() const {
  return {marks_.begin() + static_cast<std::ptrdiff_t>(written_.marks), marks_.end()};
}

/// Reason to refuse the run, in view of its samples in the ledger; `like` receives the runs that it replaces.
std::string LedgerRun::judge(Database& database, std::vector<RunRow>& like, bool end, bool replace) {
  like = runsLike(database, id_.name, machine_, marks_);
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

/// Reason to refuse a running run, as another one now has its samples.
std::string LedgerRun::newlyShared(Database& database, const RunRow& own) const {
  for (const RunRow& other : runsLike(database, id_.name, machine_, newMarks())) {
    if (other.run != own.run) return "has samples of run " + other.name + ", which is in it already: not counted twice";
  }
  return {};
}

bool LedgerRun::Written::isThat(const RunRow& row) const {
  return commits > 0 && row.pieces == commits && row.messages == messages;
}

void LedgerRun::note(const Written& commit) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(commit.pieces));
  written_ = commit;
}

/// Returns true if the ledger has the run as this object left it. A commit that reported an error may be in the file
/// all the same; the row then has the values which that commit would have written.
bool LedgerRun::isOurs(const std::vector<RunRow>& rows) {
  const std::optional<Written> failed = std::exchange(failed_, std::nullopt);
  if (!rows.empty() && failed && failed->isThat(rows.front())) note(*failed);
  if (!rows.empty() && written_.isThat(rows.front()) && rows.front().parameters == id_.parameters) return true;
  // The first piece, or the written pieces were removed: the run has only the pieces from here on.
  marks_ = newMarks();
  messages_ -= written_.messages;
  written_ = {};
  return false;
}

bool LedgerRun::put(Database& database, bool end, bool replace) {
  const std::vector<RunRow> rows = runsLike(database, id_.name);
  if (!database.good()) return true;
  const bool ours = isOurs(rows);
  std::vector<RunRow> like;
  known_ = false;
  refusal_ = contradiction();
  if (refusal_.empty()) {
    const std::string reason = ours ? newlyShared(database, rows.front()) : judge(database, like, end, replace);
    if (!reason.empty()) refusal_ = "run " + id_.name + ": " + reason;
  }
  if (!database.good()) refusal_.clear();  // not known yet
  if (!database.good()) return true;
  if (refused() && ours) removeRun(database, rows.front());
  if (refused()) return false;
  mergeDays(waiting_);
  const RunRow row = ours ? rows.front() : beginRun(database, machine_, id_, like);
  for (const LifePiece& piece : waiting_) addPiece(database, row, piece);
  setRun(database, row, written_.commits + 1, messages_, newMarks());
  return true;
}

std::optional<std::string> LedgerRun::write(bool end) {
  const auto problem = [&](const std::string& what) { return std::make_optional(path_ + ": " + what); };
  if (ended_) return refused() ? problem(refusal_) : std::nullopt;
  if (!end && refused())
    return problem(refusal_);  // the pieces are kept: at its end the run may have more than the ledger
  if (waiting_.empty() && !end && id_.refusal.empty()) return std::nullopt;

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
    if (const std::string refusal = run.contradiction(); !refusal.empty()) return path_ + ": " + refusal;
  if (std::string problem = check(); !problem.empty()) return problem;
  database_.emplace(path_, Database::Use::kWrite, kBatchPatience);
  beginAsLedger(*database_);
  checkLedger(*database_);
  std::string refused;
  for (LedgerRun& run : runs_) {
    if (run.putWhole(*database_, replace_)) continue;
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
