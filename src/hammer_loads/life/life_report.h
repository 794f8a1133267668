/// Figures of a ledger: what the loads took of a machine's life so far.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/life/ledger_reader.h"

namespace hammer_loads::life {

constexpr std::size_t kSlopeCount = std::size(kSlopes);

/// Ranges in the channel's unit.
struct ChannelFigures {
  std::array<Figure, kSlopeCount> equivalent_range;  ///< at kSlopes; NaN without any time
  double largest_range{};
  double cycles{};                        ///< half cycles of the residue included
  std::optional<Figure> damage;           ///< by the channel's S-N curve
  std::optional<Figure> remaining_hours;  ///< until the damage is 1
};

struct DayFigures {
  std::string date;
  double hours{};
  std::uint64_t blows{};
  ChannelFigures figures;  ///< of the cycles that closed on the day
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

/// The figures of a count over some hours.
ChannelFigures figuresOf(const CycleCount& count, const LedgerChannel& channel, double hours,
                         double equivalent_cycles_per_hour);

/// Every epoch of the ledger. A problem of one line when it cannot be read whole.
Checked<std::vector<EpochReport>> lifeReport(LedgerReader& reader);

}  // namespace hammer_loads::life
