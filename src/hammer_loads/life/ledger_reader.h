/// Reader of a ledger for tables and reports; a run may write to the ledger meanwhile.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/ledger_run.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads::life {

/// Days follow each other as they were written: a clock that ran back gives a date a second time or out of order.
struct LedgerDay {
  std::vector<std::int64_t> ids;  ///< one for each run that worked on it
  std::string date;               ///< date of the samples' stamps, UTC
  std::uint64_t duration{};       ///< [ns]
  std::uint64_t turns{};
};

struct LedgerEpoch {
  std::int64_t id{};
  LedgerMachine machine;
  std::vector<std::int64_t> channels;  ///< ids, in the order of machine.channels
  std::vector<LedgerDay> days;
  std::uint64_t runs{};
};

struct LedgerRunInfo {
  std::string name;
  std::int64_t epoch{};
  std::uint64_t messages{};  ///< messages of the crank
  std::uint64_t turns{};
};

/// One state of the file, that at the first query, however long the reading takes.
class LedgerReader {
 public:
  /// One line when the file cannot be read or is no ledger.
  static Checked<LedgerReader> open(const std::string& path);

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
  /// Cycles that the residues of a channel's runs close, one after another.
  struct Seams {
    std::int64_t channel{-1};
    std::map<std::int64_t, std::vector<ClosedCycles>> closed;  ///< by the last day of the run that closed them
    std::vector<std::uint32_t> residue;
  };

  explicit LedgerReader(const std::string& path);
  /// Adds what is kept of a channel where `condition` holds for `value`.
  void read(CycleCount& count, std::int64_t channel, const char* condition, std::int64_t value);
  const Seams& seamsOf(std::int64_t channel);

  std::string path_;
  std::unique_ptr<Database> database_;  ///< stays where it is: statements refer to it
  Seams seams_;                         ///< seams of the channel read last
};

}  // namespace hammer_loads::life
