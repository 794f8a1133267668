/// A ledger as it is, for tables and reports; a run may write it meanwhile.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

/// Days follow each other as they were written: a clock that ran back gives a date a second time or out of order.
struct LedgerDay {
  std::int64_t id{};
  std::string date;          ///< of the samples' stamps, UTC
  std::uint64_t duration{};  ///< [ns]
  std::uint64_t turns{};
};

struct LedgerEpoch {
  std::int64_t id{};
  LedgerMachine machine;
  std::vector<LedgerDay> days;
  std::uint64_t runs{};
};

/// One state of the file, that at the first query, however long the reading takes.
class LedgerReader {
 public:
  /// One line when the file cannot be read or is no ledger.
  static Checked<LedgerReader> open(const std::string& path);
  ~LedgerReader();
  LedgerReader(LedgerReader&&) noexcept;
  LedgerReader& operator=(LedgerReader&&) noexcept;

  /// In the order in which they began.
  std::vector<LedgerEpoch> epochs();
  /// All cycles of a channel of an epoch with the residue of all runs, the one at work included.
  CycleCount total(const LedgerEpoch& epoch, std::size_t channel);
  /// Cycles that closed on a day; no residue: it belongs to no day.
  CycleCount ofDay(const LedgerEpoch& epoch, std::size_t channel, const LedgerDay& day);

  /// One line after a failed query, whose result is then not to be used; else empty.
  std::string problem() const;

 private:
  struct State;
  explicit LedgerReader(std::unique_ptr<State> state);
  CycleCount read(const LedgerEpoch& epoch, std::size_t channel, std::int64_t first_day, std::int64_t last_day);

  std::unique_ptr<State> state_;
};

}  // namespace hammer_loads::life
