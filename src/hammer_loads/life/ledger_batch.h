/// Runs that are added to a ledger when all of them are known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

/// For recordings: all runs are one transaction, which the caller commits when its other results are safe: a recording
/// that is broken off leaves nothing. Pieces of one day are added up: memory does not grow with the recording.
class LedgerBatch final : public PieceSink {
 public:
  /// replace: runs take the place of what the ledger has of their samples.
  explicit LedgerBatch(std::string path, bool replace = false) : path_(std::move(path)), replace_(replace) {}

  void begin(const LedgerMachine& machine, const RunId& run) override { runs_.emplace_back(path_, machine, run); }
  void add(const LifePiece& piece) override { runs_.back().keep(piece); }
  void refuse(const std::string& reason) override { runs_.back().refuse(reason); }
  void end(const LifePiece& last) override { runs_.back().keep(last); }

  /// Reason why the file cannot be written as a ledger, one line; empty when it can. Changes nothing in it.
  std::string check() const;
  /// Puts every run into the ledger; it shows with commit(). One line if it could not or a run is refused; runs that
  /// were in the ledger before are named in `known`.
  std::string write(std::vector<std::string>& known);
  /// Ends what write() began. One line if it could not: then nothing is in the ledger.
  std::string commit();

 private:
  std::string path_;
  bool replace_;
  std::vector<LedgerRun> runs_;
  std::optional<Database> database_;
};

}  // namespace hammer_loads::life
