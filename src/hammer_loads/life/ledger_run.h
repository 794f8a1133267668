/// A run's part in the ledger of its machine: what its loads add to the counts of months.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {

struct LedgerChannel {
  std::string name;
  LoadGrid grid;
  std::optional<SnCurve> curve;
  std::optional<FkmMeanStress> mean_stress;
};

/// What the counts belong to. Another identity or other channels or grids begin a new epoch: counts of different
/// machines never mix. Curves and equivalent cycles only judge them: those of the last run hold.
struct LedgerMachine {
  std::string identity;  ///< of hammer and boom, such as a hash of their parameters; no path, host or time
  std::vector<LedgerChannel> channels;
  double equivalent_cycles_per_hour{};
};

/// Channels in the order of LifeRecorder::channels().
LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity);

/// Adds a run's pieces to the ledger, each in one transaction: what kill -9 or a power cut leaves is the ledger after
/// some piece. The ledger's trouble is never the caller's: nothing throws, a piece that cannot be written waits for the
/// next one, and memory stays bounded. From a thread of its own: a disk takes its time, and another reader of the file
/// up to kPatience.
///
/// One writer at a time: while another run has the ledger, pieces wait, and the problem says so. Order in the ledger is
/// that of writing, whatever the clocks say. A run that never ended (kill -9) ends when the next one begins.
class LedgerRun {
 public:
  /// `run`: unique among all runs of all machines, and the same whenever this run's pieces are added. A run that is in
  /// the ledger already is not counted again.
  LedgerRun(std::string path, LedgerMachine machine, std::string run);
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
  /// Adds a piece, and what waits. Nothing when all is written, else one line.
  std::optional<std::string> add(LifePiece piece);
  /// Adds the last piece and what waits, ends the run and releases the ledger. After a problem it may be called again,
  /// with no piece.
  std::optional<std::string> end(std::optional<LifePiece> last);

  /// Whether another run has the ledger, by the last attempt to take it.
  bool isBusy() const { return busy_; }
  /// Whether the run is refused for good: its name was in the ledger before.
  bool refused() const { return refused_; }
  /// Pieces given but not written, those of one day added up.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  class Lock;

  std::optional<std::string> write(bool end);
  std::string problem(const std::string& what) const { return path_ + ": " + what; }
  void compact(std::size_t from);

  std::string path_;
  LedgerMachine machine_;
  std::string run_;
  std::unique_ptr<Lock> lock_;
  std::vector<LifePiece> waiting_;
  std::size_t attempted_{};  ///< of waiting_, those that the last attempt may have written
  bool attempted_end_{};
  std::int64_t pieces_{};  ///< commits known to be in the ledger
  bool refused_{}, ended_{}, busy_{};
};

}  // namespace hammer_loads::life
