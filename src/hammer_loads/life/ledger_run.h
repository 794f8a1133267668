/// Writers of runs to the ledger of their machine: one run by its pieces, or several in one transaction.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

struct RunRow;

/// Merges pieces of one day that follow each other, from this index on, so that memory is bounded.
void mergeDays(std::vector<LifePiece>& pieces, std::size_t from = 0);

/// Adds a run's pieces to the ledger, each in one transaction, so that kill -9 or a power cut leaves a complete piece
/// as the last one. No function throws; a piece that cannot be written is kept for the next call, and memory is
/// bounded. Call it from a thread of its own, since a disk is slow and another user of the file may lock it for up to
/// kPatience.
///
/// Several runs may write to one ledger, one transaction at a time. Runs are ordered by their beginning, independent of
/// clocks.
///
/// A run that is in the ledger is not counted again. If the ledger has only a part of it (kill -9, a locked file), the
/// run replaces that part when it ends. A run with other sensor parameters replaces the earlier one only if asked to. A
/// run that is a part of a longer run in the ledger is refused. A run that was removed from the ledger while it was
/// written continues there with the pieces that follow.
class LedgerRun {
 public:
  LedgerRun(std::string path, LedgerMachine machine, RunId run);

  static constexpr int kPatience = 1000;  ///< [ms]

  /// Keeps a piece for the next add() or end(); does not touch the file.
  void keep(LifePiece piece);
  /// Marks the run as not to be counted: the next add() or end() removes it from the ledger.
  void refuse(const std::string& reason) { contradiction_ = "run " + id_.name + ": is not counted: " + reason; }
  /// Adds a piece, unless it is empty, and the waiting ones. Empty if all are written, otherwise one line.
  std::optional<std::string> add(LifePiece piece = {}) { return keep(std::move(piece)), write(false); }
  /// Adds the last piece and what waits, and ends the run. After a problem it may be called again, with an empty piece.
  std::optional<std::string> end(LifePiece last) { return keep(std::move(last)), write(true); }

  /// Reason why the run is not counted, one line; empty: it is. Until its end that can change: the ledger may have
  /// less.
  const std::string& refusal() const { return refusal_; }
  bool refused() const { return !refusal_.empty(); }
  /// Returns true if it is refused because all of it is in the ledger.
  bool known() const { return known_; }
  /// The refusal that refuse() gives; empty: none.
  const std::string& contradiction() const { return contradiction_; }
  /// Puts the run into a transaction that the caller began and ends. end: nothing follows. replace: it replaces runs
  /// with the same samples. False: it is refused.
  bool put(Database& database, bool end, bool replace);
  /// Pieces given but not written, those of one day added up.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  /// Part of the run that is in the ledger after a commit.
  struct Written {
    std::int64_t commits{};
    std::size_t pieces{}, marks{};  ///< numbers of those waiting that this commit wrote
    std::uint64_t messages{};
    bool isThat(const RunRow& row) const;
  };

  std::optional<std::string> write(bool end);
  std::string judge(Database& database, const std::vector<RunRow>& like, bool end, bool replace);
  bool isOurs(const std::vector<RunRow>& rows);
  void note(const Written& commit);

  std::string path_;
  LedgerMachine machine_;
  RunId id_;
  std::vector<LifePiece> waiting_;
  std::vector<std::int64_t> marks_;  ///< marks of pieces given, not known to be written
  std::uint64_t messages_{};         ///< messages of all pieces given
  Written written_;                  ///< known to be in the ledger
  std::optional<Written> failed_;    ///< reported an error, and may be in the file all the same
  bool ended_{}, known_{};
  std::string refusal_, contradiction_;
};

/// Reason why the file cannot be written as a ledger, one line; empty when it can. Changes nothing. Waits up to
/// `patience` [ms] for others to release it.
std::string ledgerProblem(const std::string& path, int patience = LedgerRun::kPatience);

/// Removes a run from the ledger. Empty if it was removed, otherwise one line.
std::optional<std::string> removeFromLedger(const std::string& path, const std::string& name);

/// For recordings. All runs are one transaction, which the caller commits once its other results are written, so that
/// an interrupted command changes nothing. Pieces of one day are merged, so that memory does not grow with the
/// recording.
class LedgerBatch final : public PieceSink {
 public:
  /// replace: runs replace those of the ledger with the same samples.
  explicit LedgerBatch(std::string path, bool replace = false) : path_(std::move(path)), replace_(replace) {}

  void begin(const LedgerMachine& machine, const RunId& run) override { runs_.emplace_back(path_, machine, run); }
  void add(const LifePiece& piece) override { runs_.back().keep(piece); }
  void refuse(const std::string& reason) override { runs_.back().refuse(reason); }
  void end(const LifePiece& last) override { runs_.back().keep(last); }

  /// Reason why the file cannot be written as a ledger, one line; empty when it can. Changes nothing in it.
  std::string check() const;
  /// Writes every run, visible to others after commit(). Returns one line if this fails or a run is refused; `known`
  /// receives the runs that were in the ledger before.
  std::string write(std::vector<std::string>& known);
  /// Commits the transaction of write(). Returns one line if this fails; the ledger is then unchanged.
  std::string commit();

 private:
  std::string path_;
  bool replace_;
  std::vector<LedgerRun> runs_;
  std::optional<Database> database_;
};

}  // namespace hammer_loads::life
