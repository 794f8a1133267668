/// Runs that are added to a ledger in one transaction.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

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
