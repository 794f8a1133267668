/// Receivers of the pieces of runs. The receiver of a live node is loaded on demand, so that a node without a ledger
/// does not need SQLite.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/util/checked.h"

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

class LiveLedger : public PieceSink {
 public:
  struct State {
    /// Problem of the last attempt, or the reason why the last refused run is not in the ledger; one line, empty
    /// without a problem.
    std::string problem;
    std::size_t waiting{};  ///< pieces given but not written, those of one day added up
  };
  virtual State state() const = 0;
  virtual const std::string& path() const = 0;
  /// Makes a last attempt and accepts no more pieces. Empty if all are written, otherwise one line.
  virtual std::optional<std::string> close() = 0;
};

/// Loads libhammer_loads_ledger.so. A problem of one line when that cannot be.
Checked<std::unique_ptr<LiveLedger>> loadLedger(const std::string& path);

}  // namespace hammer_loads::life
