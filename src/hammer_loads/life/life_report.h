/// Figures of a ledger: damage and remaining life of a machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_reader.h"

namespace hammer_loads::life {

struct DayFigures {
  std::string date;
  double hours{};
  std::uint64_t blows{};
  ChannelFigures figures;  ///< figures of the cycles that closed on the day
};

struct ChannelReport {
  std::string name, unit;
  double hours{};
  std::uint64_t blows{};
  ChannelFigures figures;
  SampleTally tally;
  Extremes extremes;
  std::vector<DayFigures> days;
};

struct EpochReport {
  LedgerEpoch epoch;
  std::vector<ChannelReport> channels;
};

/// Every epoch of the ledger. A problem of one line when it cannot be read whole.
Checked<std::vector<EpochReport>> lifeReport(LedgerReader& reader);

}  // namespace hammer_loads::life
