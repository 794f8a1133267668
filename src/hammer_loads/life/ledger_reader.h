/// Reader of a ledger for tables and reports. A run may write to the ledger meanwhile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/database.h"
#include "hammer_loads/life/life_settings.h"

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
  std::vector<LedgerDay> days;
  std::uint64_t runs{};
};

/// Counts of a channel in an epoch.
struct LedgerCounts {
  CycleCount total;  ///< with the residue of all runs, the one at work included
  /// Cycles that closed on each day, those that a run closes with the residues before it on the run's last one; no
  /// residue: it belongs to no day.
  std::vector<CycleCount> days;
};

/// One state of the file, that at the first query, however long the reading takes.
class LedgerReader {
 public:
  /// A file that cannot be read or is no ledger is a problem().
  explicit LedgerReader(const std::string& path);

  /// In the order in which they began.
  std::vector<LedgerEpoch> epochs();
  /// CSV of the runs in the order in which they count.
  std::string runs();
  LedgerCounts counts(const LedgerEpoch& epoch, const CountedChannel& channel);

  /// One line after a failed query, whose result is then not to be used; else empty.
  std::string problem() const { return database_.good() ? "" : path_ + ": " + database_.problem(); }

 private:
  std::string path_;
  Database database_;
};

}  // namespace hammer_loads::life
