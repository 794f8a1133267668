/// Runs that are added to a ledger when all of them are known.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hammer_loads/life/piece_sink.h"

namespace hammer_loads::life {

/// For recordings: each run is one transaction, so that a recording that is broken off leaves no part of a run, which
/// would count as the run. Pieces of one day are added up: memory does not grow with the recording.
class LedgerBatch final : public PieceSink {
 public:
  /// busy: called once a time that another run has the ledger, with the line that says so; waiting goes on then.
  LedgerBatch(std::string path, std::function<void(const std::string&)> busy);

  void begin(const LedgerMachine& machine, const std::string& run) override;
  void add(const LifePiece& piece) override;
  void end(const LifePiece& last) override;

  /// Why the file cannot be written as a ledger, one line; empty when it can. Changes nothing in it.
  std::string check();
  /// Writes every run. One line if it could not; runs that were in the ledger before are named in `known`.
  std::string write(std::vector<std::string>& known);

 private:
  std::optional<std::string> waitFor(LedgerRun& run);

  std::string path_;
  std::function<void(const std::string&)> busy_;
  std::vector<LedgerRun> runs_;
};

}  // namespace hammer_loads::life
