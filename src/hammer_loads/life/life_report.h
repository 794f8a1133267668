/// Figures of a ledger: damage and remaining life of a machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_reader.h"

namespace hammer_loads::life {

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
