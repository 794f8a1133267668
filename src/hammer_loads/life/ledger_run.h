/// A run's part in the ledger of its machine: what its loads add to the counts of months.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_lock.h"
#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {

struct LedgerChannel {
  std::string name;
  LoadGrid grid;
  std::optional<SnCurve> curve;
  std::optional<FkmMeanStress> mean_stress;
};

/// The machine of the counts. Another identity or other channels or grids begin a new epoch: counts of different
/// machines never mix. Curves and equivalent cycles only judge them: those of the last run hold.
struct LedgerMachine {
  std::string identity;  ///< of hammer and boom, such as a hash of their parameters; no path, host or time
  std::vector<LedgerChannel> channels;
  double equivalent_cycles_per_hour{};
};

/// Channels in the order of LifeRecorder::channels().
LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity);

/// One recording of one machine with one set of sensor parameters.
struct RunId {
  std::string name;          ///< the same whenever this recording is counted, with whatever sensor parameters
  std::string parameters{};  ///< a digest of those of sensors; empty: not known
  std::string older{};       ///< its name in ledgers of version 1
  std::string refusal{};     ///< why it is not to be counted, one line; empty: it is

  RunId(const char* of) : name(of) {}
  RunId(std::string of) : name(std::move(of)) {}
};

class Database;
struct RunRow;

/// Adds a run's pieces to the ledger, each in one transaction: what kill -9 or a power cut leaves is the ledger after
/// some piece. The ledger's trouble is never the caller's: nothing throws, a piece that cannot be written waits for the
/// next one, and memory stays bounded. From a thread of its own: a disk takes its time, and another reader of the file
/// up to kPatience.
///
/// One writer at a time: while another run has the ledger, pieces wait, and the problem says so. Order in the ledger is
/// that of beginning, whatever the clocks say.
///
/// A run that is in the ledger is not counted again. Where the ledger has less of it (kill -9, a locked file), the run
/// takes that one's place when it ends. One with other sensor parameters does so only when it is to replace. A run that
/// shares samples with a longer one is a part of it and refused.
class LedgerRun {
 public:
  LedgerRun(std::string path, LedgerMachine machine, RunId run);
  ~LedgerRun();
  LedgerRun(LedgerRun&&) noexcept;
  LedgerRun& operator=(LedgerRun&&) noexcept;

  static constexpr int kPatience = 1000;  ///< [ms]

  /// Takes the ledger, if no other run has it. Nothing when it is this run's now, else one line; call again later.
  std::optional<std::string> hold();
  /// The same, and looks whether what is there is a ledger; changes nothing in it.
  std::optional<std::string> prepare();
  /// Keeps a piece for the next add() or end(); does not touch the file.
  void keep(LifePiece piece);
  /// The run is not to be counted: with the next add() or end() what the ledger has of it goes.
  void refuse(const std::string& reason) { id_.refusal = reason; }
  /// Adds a piece, and what waits. Nothing when all is written, else one line.
  std::optional<std::string> add(LifePiece piece);
  /// Adds the last piece and what waits, ends the run and releases the ledger. After a problem it may be called again,
  /// with no piece.
  std::optional<std::string> end(std::optional<LifePiece> last);

  /// Name under which the ledger that it holds is opened.
  const std::string& lockedName() const { return lock_->name(); }
  /// Whether another run has the ledger, by the last attempt to take it.
  bool isBusy() const { return busy_; }
  /// Why the run is not counted, one line; empty: it is. Until its end that can change: the ledger may have less.
  bool refused() const { return !refusal_.empty(); }
  const std::string& refusal() const { return refusal_; }
  /// Whether it is refused because all of it is in the ledger.
  bool known() const { return known_; }
  /// Puts the whole run into a transaction that the caller began and ends. False: it is refused.
  bool putWhole(Database& database, bool replace);
  /// Pieces given but not written, those of one day added up.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  std::optional<std::string> write(bool end);
  bool put(Database& database, bool end, bool replace);
  std::optional<std::string> judge(Database& database, std::vector<RunRow>& like, bool end, bool replace);
  bool wasWritten(const RunRow& row);
  std::string problem(const std::string& what) const { return path_ + ": " + what; }
  void compact(std::size_t from);

  std::string path_;
  LedgerMachine machine_;
  RunId id_;
  std::unique_ptr<LedgerLock> lock_;
  std::vector<LifePiece> waiting_;
  std::uint64_t messages_{};         ///< of all pieces given
  std::vector<std::int64_t> marks_;  ///< as above
  std::size_t marks_written_{};
  std::size_t attempted_{};  ///< of waiting_, those that the last attempt may have written
  std::uint64_t attempted_messages_{};
  bool attempting_{};      ///< whether a commit has failed, and may be in the file all the same
  std::int64_t pieces_{};  ///< commits known to be in the ledger
  bool ended_{}, busy_{}, known_{};
  std::string refusal_;
};

/// Takes a run out of the ledger. Nothing when it is done, else one line.
std::optional<std::string> removeFromLedger(const std::string& path, const std::string& name);

}  // namespace hammer_loads::life
