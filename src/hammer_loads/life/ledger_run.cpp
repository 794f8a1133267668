#include "hammer_loads/life/ledger_run.h"

#include <unistd.h>

#include <utility>

#include "hammer_loads/life/ledger_schema.h"
#include "hammer_loads/life/ledger_writer.h"

namespace hammer_loads::life {

namespace {

bool isEmpty(const LifePiece& piece) {
  for (const CycleCount& count : piece.counts) {
    if (count.tally.counted + count.tally.skipped + count.tally.gaps > 0) return false;
  }
  return piece.duration == 0 && piece.turns == 0;
}

}  // namespace

LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity) {
  LedgerMachine machine{identity, {}, settings.equivalent_cycles_per_hour};
  for (const CountedChannel& c : settings.channels) machine.channels.push_back({c.name, c.grid, {}, {}});
  for (const HotSpot& spot : settings.hot_spots)
    machine.channels.push_back({hotSpotChannel(spot), spot.grid, spot.curve, spot.mean_stress});
  return machine;
}

LedgerRun::LedgerRun(std::string path, LedgerMachine machine, RunId run)
    : path_(std::move(path)), machine_(std::move(machine)), id_(std::move(run)) {}
LedgerRun::~LedgerRun() = default;
LedgerRun::LedgerRun(LedgerRun&&) noexcept = default;
LedgerRun& LedgerRun::operator=(LedgerRun&&) noexcept = default;

std::optional<std::string> LedgerRun::hold() {
  if (lock_ && lock_->isAt(path_)) return std::nullopt;
  lock_.reset();
  std::string trouble;
  lock_ = LedgerLock::take(path_, trouble, busy_);
  if (lock_) return std::nullopt;
  return problem(trouble);
}

std::optional<std::string> LedgerRun::prepare() {
  const bool held = lock_ != nullptr;
  if (std::optional<std::string> trouble = hold()) return trouble;
  std::string trouble;
  {
    Database database(lock_->name(), Database::Use::kWrite, kPatience);
    beginAsLedger(database);
    database.run("ROLLBACK");
    trouble = database.problem();
  }
  if (trouble.empty()) return std::nullopt;
  if (!held) lock_.reset();
  return problem(trouble);
}

void LedgerRun::keep(LifePiece piece) {
  messages_ += piece.messages;
  marks_.insert(marks_.end(), piece.marks.begin(), piece.marks.end());
  piece.marks.clear();
  if (!isEmpty(piece)) waiting_.push_back(std::move(piece));
  compact(attempted_);
}

std::optional<std::string> LedgerRun::add(LifePiece piece) {
  keep(std::move(piece));
  return write(false);
}

std::optional<std::string> LedgerRun::end(std::optional<LifePiece> last) {
  if (last) keep(*std::move(last));
  std::optional<std::string> trouble = write(true);
  if (!trouble || refused()) lock_.reset();
  return trouble;
}

void LedgerRun::compact(std::size_t from) {
  for (std::size_t i = waiting_.size(); i > from + 1; --i) {
    LifePiece& before = waiting_[i - 2];
    if (dayOf(before.stamp) != dayOf(waiting_[i - 1].stamp)) continue;
    before.advance(waiting_[i - 1]);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i - 1));
  }
}

/// Why the run is refused, in view of what the ledger has of its samples; `like` is what it takes the place of.
std::optional<std::string> LedgerRun::judge(Database& database, std::vector<RunRow>& like, bool end, bool replace) {
  known_ = false;
  if (!id_.refusal.empty()) return "is not counted: " + id_.refusal;
  like = runsLike(database, machine_, id_, marks_);
  for (const RunRow& row : like) {
    const std::string sizes = std::to_string(messages_) + " of its " + std::to_string(row.messages) + " samples";
    if (!row.apart) {
      known_ = true;
      return "is in it already, not counted again (by a version that kept no run apart: it cannot be replaced)";
    }
    if (replace && messages_ >= row.messages) continue;
    if (replace)
      return "cannot replace run " + row.name + ": holds " + sizes + "; life --remove takes that one out first";
    const bool other = !id_.parameters.empty() && !row.parameters.empty() && id_.parameters != row.parameters;
    if (other && row.name == id_.name)
      return "is in it already with other sensor parameters; process_bag --replace-run puts this one in its place";
    if (end && !other && messages_ > row.messages && holdsMarksOf(database, row, marks_)) continue;
    known_ = row.name == id_.name;
    if (known_) return "is in it already, not counted again";
    return "has samples of run " + row.name +
           ", which is in it already; a part of a recording counts with all its parts in one call, and "
           "process_bag --replace-run puts a whole one in its place";
  }
  return std::nullopt;
}

/// A commit that reported an error may be in the file all the same: what it would have made of the run's row shows it.
bool LedgerRun::wasWritten(const RunRow& row) {
  if (!attempting_ || row.pieces != pieces_ + 1 || row.messages != attempted_messages_) return false;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(attempted_));
  ++pieces_;
  return true;
}

bool LedgerRun::put(Database& database, bool end, bool replace) {
  std::optional<RunRow> row = findRun(database, id_.name);
  if (!database.good()) return true;
  const bool ours = row && ((pieces_ > 0 && row->pieces == pieces_ && row->apart) || wasWritten(*row));
  attempting_ = false;
  attempted_ = 0;
  std::vector<RunRow> like;
  if (!ours) pieces_ = 0, marks_written_ = 0;  // a first piece, or another file than before
  std::optional<std::string> refusal;
  if (!ours) {
    refusal = judge(database, like, end, replace);
  } else {
    if (!id_.refusal.empty()) refusal = "is not counted: " + id_.refusal;
    const std::vector<std::int64_t> fresh(marks_.begin() + static_cast<std::ptrdiff_t>(marks_written_), marks_.end());
    for (const RunRow& other : runsLike(database, machine_, id_, fresh)) {
      if (other.run != row->run && !refusal)
        refusal = "has samples of run " + other.name + ", which is in it already: not counted twice";
    }
    if (refusal) removeRun(database, *row);
  }
  if (!database.good()) return true;
  refusal_ = refusal ? "run " + id_.name + ": " + *refusal : "";
  if (refusal) return false;
  compact(0);
  if (!ours) row = like.empty() ? beginRun(database, machine_, id_) : replaceRuns(database, machine_, id_, like);
  for (const LifePiece& piece : waiting_) addPiece(database, *row, piece);
  addMarks(database, *row, marks_, marks_written_);
  setRun(database, *row, pieces_ + 1, messages_, end);
  return true;
}

bool LedgerRun::putWhole(Database& database, bool replace) { return put(database, true, replace); }

std::optional<std::string> LedgerRun::write(bool end) {
  if (ended_) return refused() ? std::make_optional(problem(refusal_)) : std::nullopt;
  const bool gives_up = !id_.refusal.empty();
  if (!end && refused()) return problem(refusal_);  // the pieces stay: at its end the run may have more than the ledger
  if (waiting_.empty() && !end && !gives_up) return std::nullopt;
  if (std::optional<std::string> trouble = hold()) return trouble;

  Database database(lock_->name(), Database::Use::kWrite, kPatience);
  beginAsLedger(database);
  const bool taken = put(database, end, false);
  if (database.good()) {
    attempting_ = taken;
    attempted_ = taken ? waiting_.size() : 0;
    attempted_messages_ = messages_;
  }
  database.run("COMMIT");
  if (!database.good()) return problem(database.problem());
  attempting_ = false;
  attempted_ = 0;
  ended_ = end;
  if (taken) ++pieces_, marks_written_ = marks_.size();
  if (taken || end) waiting_.clear();
  if (taken) return std::nullopt;
  return problem(refusal_);
}

std::optional<std::string> removeFromLedger(const std::string& path, const std::string& name) {
  std::string trouble;
  bool busy = false;
  if (access(path.c_str(), F_OK) != 0) return path + ": does not exist";
  const std::unique_ptr<LedgerLock> lock = LedgerLock::take(path, trouble, busy);
  if (!lock) return path + ": " + (busy ? "another run is writing it; remove the run when that has ended" : trouble);
  Database database(lock->name(), Database::Use::kWrite, LedgerRun::kPatience);
  beginAsLedger(database);
  const std::optional<RunRow> row = findRun(database, name);
  if (!row) database.fail("has no run " + name + "; --runs lists them");
  if (row && !row->apart)
    database.fail("run " + name + ": was counted by a version that kept no run apart: it cannot be taken out");
  if (database.good()) removeRun(database, *row);
  database.run("COMMIT");
  if (!database.good()) return path + ": " + database.problem();
  return std::nullopt;
}

}  // namespace hammer_loads::life
