/// Receiver of the pieces of runs.
#pragma once

#include <string>

#include "hammer_loads/life/ledger_machine.h"
#include "hammer_loads/life/life_recorder.h"

namespace hammer_loads::life {

/// Runs one after another, each with its pieces in their order.
class PieceSink {
 public:
  virtual ~PieceSink() = default;
  /// machine, run: as LedgerRun takes them.
  virtual void begin(const LedgerMachine& machine, const RunId& run) = 0;
  virtual void add(const LifePiece& piece) = 0;
  /// Marks the run begun last as not to be counted, with a reason of one line; it is removed from the ledger. Call
  /// before end().
  virtual void refuse(const std::string& reason) = 0;
  /// Ends the run begun last, with its last piece.
  virtual void end(const LifePiece& last) = 0;
};

}  // namespace hammer_loads::life
