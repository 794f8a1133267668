/// Reader of a ledger for tables and reports, with the figures of damage and remaining life. A run may write to the
/// ledger meanwhile.
#pragma once

#include <cstdint>
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
  std::vector<LedgerDay> days;
  std::uint64_t runs{};
};

struct LedgerRunInfo {
  std::string name;
  std::int64_t epoch{};
  std::uint64_t messages{};  ///< messages of the crank
  std::uint64_t turns{};
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
  /// One line when the file cannot be read or is no ledger.
  static Checked<LedgerReader> open(const std::string& path);

  /// In the order in which they began.
  std::vector<LedgerEpoch> epochs();
  /// In the order in which they count.
  std::vector<LedgerRunInfo> runs();
  LedgerCounts counts(const LedgerEpoch& epoch, const LedgerChannel& channel);

  /// One line after a failed query, whose result is then not to be used; else empty.
  std::string problem() const;

 private:
  explicit LedgerReader(const std::string& path);

  std::string path_;
  std::unique_ptr<Database> database_;  ///< stays where it is: statements refer to it
};

struct PeriodFigures {
  std::string day;  ///< date; `all` for the whole epoch
  double hours{};
  std::uint64_t blows{};
  ChannelFigures figures;  ///< a day has the cycles that closed on it
};

struct ChannelReport {
  std::string name, unit;
  std::vector<PeriodFigures> periods;  ///< the whole epoch, then its days
  SampleTally tally;
  Extremes extremes;
};

struct EpochReport {
  LedgerEpoch epoch;
  std::vector<ChannelReport> channels;
};

/// Every epoch of the ledger. A problem of one line when it cannot be read whole.
Checked<std::vector<EpochReport>> lifeReport(LedgerReader& reader);

}  // namespace hammer_loads::life
