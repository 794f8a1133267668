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
  std::vector<std::int64_t> ids;  ///< one for each run that worked on it
  std::string date;               ///< of the samples' stamps, UTC
  std::uint64_t duration{};       ///< [ns]
  std::uint64_t turns{};
};

struct LedgerEpoch {
  std::int64_t id{};
  LedgerMachine machine;
  std::vector<LedgerDay> days;
  std::uint64_t runs{};
};

struct LedgerRunInfo {
  std::string name;
  std::int64_t epoch{};
  std::uint64_t messages{};  ///< of the crank
  std::uint64_t turns{};
  bool apart{};  ///< false: counted by version 1, in one sum with others; can be neither removed nor replaced
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
  /// In the order in which they count.
  std::vector<LedgerRunInfo> runs();
  /// All cycles of a channel of an epoch with the residue of all runs, the one at work included.
  CycleCount total(const LedgerEpoch& epoch, std::size_t channel);
  /// Cycles that closed on a day, those that a run closes with the residues before it on the run's last one; no
  /// residue: it belongs to no day.
  CycleCount ofDay(const LedgerEpoch& epoch, std::size_t channel, const LedgerDay& day);

  /// One line after a failed query, whose result is then not to be used; else empty.
  std::string problem() const;

 private:
  struct State;
  explicit LedgerReader(std::unique_ptr<State> state);
  std::int64_t idOf(const LedgerEpoch& epoch, std::size_t channel);
  /// Adds what is kept of a day; of all for nothing.
  void read(std::int64_t channel, std::optional<std::int64_t> day, CycleCount& count);
  struct Seams;
  const Seams& seams(std::int64_t epoch, std::int64_t channel);

  std::unique_ptr<State> state_;
};

}  // namespace hammer_loads::life
