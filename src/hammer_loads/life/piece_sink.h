/// Where the pieces of runs go.
#pragma once

#include <string>

#include "hammer_loads/life/ledger_run.h"

namespace hammer_loads::life {

/// Runs one after another, each with its pieces in their order.
class PieceSink {
 public:
  virtual ~PieceSink() = default;
  /// machine, run: as LedgerRun takes them.
  virtual void begin(const LedgerMachine& machine, const std::string& run) = 0;
  virtual void add(const LifePiece& piece) = 0;
  /// Of the run begun last, and its last piece.
  virtual void end(const LifePiece& last) = 0;
};

}  // namespace hammer_loads::life
