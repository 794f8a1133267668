#include "hammer_loads/life/ledger_run.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hammer_loads/life/ledger_schema.h"
#include "hammer_loads/life/ledger_writer.h"

namespace hammer_loads::life {

/// Of a file beside the ledger, released by the kernel however the process ends. Not of the ledger itself: closing a
/// second handle of it would release SQLite's own locks.
class LedgerRun::Lock {
 public:
  /// Nothing after a problem.
  static std::unique_ptr<Lock> take(const std::string& path, std::string& problem, bool& busy) {
    const std::string name = path + ".lock";
    constexpr int kHow = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW;
    int file = open(name.c_str(), kHow | O_EXCL, 0666);
    const bool made = file >= 0;
    if (!made) file = open(name.c_str(), kHow, 0666);
    if (file < 0) {
      problem = std::string("its lock cannot be opened: ") + std::strerror(errno);
      return nullptr;
    }
    auto lock = std::unique_ptr<Lock>(new Lock(file, made ? name : ""));
    const bool locked = flock(file, LOCK_EX | LOCK_NB) == 0;
    if (locked && isAt(name, file)) return lock;
    busy = locked || errno == EWOULDBLOCK;
    problem = busy ? "another run is writing it; waiting for that to end"
                   : std::string("its lock cannot be taken: ") + std::strerror(errno);
    return nullptr;
  }
  ~Lock() { close(file_); }
  /// Leaves no file behind that was not there before.
  void remove() {
    if (!made_.empty()) unlink(made_.c_str());
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  /// False: another run has removed it between opening and locking.
  static bool isAt(const std::string& name, int file) {
    struct stat there {
    }, here{};
    return stat(name.c_str(), &there) == 0 && fstat(file, &here) == 0 && there.st_ino == here.st_ino;
  }
  Lock(int file, std::string made) : file_(file), made_(std::move(made)) {}
  int file_;
  std::string made_;  ///< its name; empty where it was there before
};

namespace {

bool isSomethingElse(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

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

LedgerRun::LedgerRun(std::string path, LedgerMachine machine, std::string run)
    : path_(std::move(path)), machine_(std::move(machine)), run_(std::move(run)) {}
LedgerRun::~LedgerRun() = default;
LedgerRun::LedgerRun(LedgerRun&&) noexcept = default;
LedgerRun& LedgerRun::operator=(LedgerRun&&) noexcept = default;

std::optional<std::string> LedgerRun::hold() {
  if (lock_) return std::nullopt;
  std::string trouble;
  busy_ = false;
  if (isSomethingElse(path_)) {
    trouble = "is no regular file";
  } else {
    lock_ = Lock::take(path_, trouble, busy_);
  }
  if (lock_) return std::nullopt;
  return problem(trouble);
}

std::optional<std::string> LedgerRun::prepare() {
  const bool held = lock_ != nullptr;
  if (std::optional<std::string> trouble = hold()) return trouble;
  if (access(path_.c_str(), F_OK) != 0) return std::nullopt;
  Database database(path_, Database::Use::kWrite, kPatience);
  beginAsLedger(database);
  database.run("ROLLBACK");
  if (database.good()) return std::nullopt;
  if (!held) {
    lock_->remove();
    lock_.reset();
  }
  return problem(database.problem());
}

void LedgerRun::keep(LifePiece piece) {
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
  if (!trouble) lock_.reset();
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

std::optional<std::string> LedgerRun::write(bool end) {
  if (ended_ || (waiting_.empty() && !end)) return std::nullopt;
  if (refused_) {
    waiting_.clear();
    return problem("run " + run_ + ": is in it already, not counted again");
  }
  if (std::optional<std::string> trouble = hold()) return trouble;

  Database database(path_, Database::Use::kWrite, kPatience);
  beginAsLedger(database);
  std::optional<RunRow> row = findRun(database, run_);
  if (!database.good()) return problem(database.problem());
  // A commit that reported an error may be in the file all the same: the number of pieces shows it.
  const bool attempted = attempted_ > 0 || attempted_end_;
  if (row && attempted && row->pieces == pieces_ + 1) {
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(attempted_));
    ++pieces_;
  } else if (row && (row->pieces != pieces_ || row->ended)) {
    refused_ = true;
    waiting_.clear();
    return problem("run " + run_ + ": is in it already, not counted again");
  } else if (!row) {
    pieces_ = 0;  // a first piece, or another file than before
  }
  attempted_ = 0;
  attempted_end_ = false;
  compact(0);
  if (!row) row = beginRun(database, machine_, run_);
  for (const LifePiece& piece : waiting_) addPiece(database, *row, piece);
  setPieces(database, *row, pieces_ + 1);
  if (end && !row->ended) endRun(database, *row);
  if (database.good()) {
    attempted_ = waiting_.size();
    attempted_end_ = end;
  }
  database.run("COMMIT");
  if (!database.good()) return problem(database.problem());
  ++pieces_;
  waiting_.clear();
  attempted_ = 0;
  attempted_end_ = false;
  ended_ = end;
  return std::nullopt;
}

}  // namespace hammer_loads::life
