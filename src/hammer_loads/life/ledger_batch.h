/// Runs that are added to a ledger when all of them are known.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

/// For recordings: all runs are one transaction, which the caller commits when its other results are safe: a recording
/// that is broken off leaves nothing. Pieces of one day are added up: memory does not grow with the recording.
class LedgerBatch final : public PieceSink {
 public:
  /// busy: called once a time that another run has the ledger, with the line that says so; waiting goes on then.
  /// replace: runs take the place of what the ledger has of their samples.
  LedgerBatch(std::string path, std::function<void(const std::string&)> busy, bool replace = false);
  ~LedgerBatch() override;

  void begin(const LedgerMachine& machine, const RunId& run) override;
  void add(const LifePiece& piece) override;
  void refuse(const std::string& reason) override;
  void end(const LifePiece& last) override;

  /// Why the file cannot be written as a ledger, one line; empty when it can. Changes nothing in it.
  std::string check();
  /// Puts every run into the ledger; it shows with commit(). One line if it could not or a run is refused; runs that
  /// were in the ledger before are named in `known`.
  std::string write(std::vector<std::string>& known);
  /// Ends what write() began. One line if it could not: then nothing is in the ledger.
  std::string commit();

 private:
  std::string wait();

  std::string path_;
  std::function<void(const std::string&)> busy_;
  bool replace_;
  std::vector<LedgerRun> runs_;
  LedgerRun gate_;  ///< holds the ledger
  std::unique_ptr<Database> database_;
};

}  // namespace hammer_loads::life
