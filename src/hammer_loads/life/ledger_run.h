/// A run's part in the ledger of its machine: what its loads add to the counts of months.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_machine.h"
#include "hammer_loads/life/life_recorder.h"

namespace hammer_loads::life {

class Database;
struct RunRow;

/// Adds a run's pieces to the ledger, each in one transaction: what kill -9 or a power cut leaves is the ledger after
/// some piece. The ledger's trouble is never the caller's: nothing throws, a piece that cannot be written waits for the
/// next one, and memory stays bounded. From a thread of its own: a disk takes its time, and another user of the file up
/// to kPatience.
///
/// Several runs may write one ledger, a transaction at a time. Order in the ledger is that of beginning, whatever the
/// clocks say.
///
/// A run that is in the ledger is not counted again. Where the ledger has less of it (kill -9, a locked file), the run
/// takes that one's place when it ends. One with other sensor parameters does so only when it is to replace. A run that
/// shares samples with a longer one is a part of it and refused. A run that was taken out of the ledger while it wrote
/// restarts there, with what follows.
class LedgerRun {
 public:
  LedgerRun(std::string path, LedgerMachine machine, RunId run);

  static constexpr int kPatience = 1000;  ///< [ms]

  /// Keeps a piece for the next add() or end(); does not touch the file.
  void keep(LifePiece piece);
  /// The run is not to be counted: with the next add() or end() what the ledger has of it goes.
  void refuse(const std::string& reason) { id_.refusal = reason; }
  /// Adds a piece, and what waits. Nothing when all is written, else one line.
  std::optional<std::string> add(LifePiece piece);
  /// Adds what waits.
  std::optional<std::string> add() { return write(false); }
  /// Adds the last piece and what waits, and ends the run. After a problem it may be called again, with no piece.
  std::optional<std::string> end(std::optional<LifePiece> last);

  /// Reason why the run is not counted, one line; empty: it is. Until its end that can change: the ledger may have
  /// less.
  const std::string& refusal() const { return refusal_; }
  bool refused() const { return !refusal_.empty(); }
  /// Returns true if it is refused because all of it is in the ledger.
  bool known() const { return known_; }
  /// The refusal that refuse() gives; empty: none.
  std::string contradiction() const;
  /// Puts the whole run into a transaction that the caller began and ends. False: it is refused.
  bool putWhole(Database& database, bool replace) { return put(database, true, replace); }
  /// Pieces given but not written, those of one day added up.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  /// Contents of a commit, the first of the waiting pieces.
  struct Commit {
    std::size_t pieces{}, marks{};
    std::uint64_t messages{};
  };

  std::optional<std::string> write(bool end);
  bool put(Database& database, bool end, bool replace);
  std::optional<std::string> judge(Database& database, std::vector<RunRow>& like, bool end, bool replace);
  std::optional<std::string> newlyShared(Database& database, const RunRow& own) const;
  bool isOurs(const std::optional<RunRow>& row);
  void noteWritten(const Commit& commit);
  void compact(std::size_t from);

  std::string path_;
  LedgerMachine machine_;
  RunId id_;
  std::vector<LifePiece> waiting_;
  std::uint64_t messages_{}, messages_written_{};  ///< messages of all pieces given; of those in the ledger
  std::vector<std::int64_t> marks_;                ///< marks of all pieces given
  std::size_t marks_written_{};
  std::int64_t commits_{};        ///< known to be in the ledger
  std::optional<Commit> failed_;  ///< reported an error, and may be in the file all the same
  bool ended_{}, known_{};
  std::string refusal_;
};

/// Reason why the file cannot be written as a ledger, one line; empty when it can. Changes nothing. Waits up to
/// `patience` [ms] for others to release it.
std::string ledgerProblem(const std::string& path, int patience = LedgerRun::kPatience);

/// Takes a run out of the ledger. Nothing when it is done, else one line.
std::optional<std::string> removeFromLedger(const std::string& path, const std::string& name);

}  // namespace hammer_loads::life
