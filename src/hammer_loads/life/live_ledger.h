/// The ledger of a live node, which is loaded when it is asked for: a node without one needs no SQLite.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "hammer_loads/life/piece_sink.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

class LiveLedger : public PieceSink {
 public:
  struct State {
    /// Problem of the last attempt, else the reason why the last refused run is not in the ledger; one line, empty: all
    /// is well.
    std::string problem;
    std::size_t waiting{};  ///< pieces given but not written, those of one day added up
  };
  virtual State state() const = 0;
  virtual const std::string& path() const = 0;
  /// A last attempt; then nothing more is taken. Nothing when all is written, else one line.
  virtual std::optional<std::string> close() = 0;
};

/// Loads libhammer_loads_ledger.so. A problem of one line when that cannot be.
Checked<std::unique_ptr<LiveLedger>> loadLedger(const std::string& path);

}  // namespace hammer_loads::life
