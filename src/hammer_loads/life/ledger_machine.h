/// Machine of a ledger, its S-N curves, and the figures of a count.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/life/damage.h"
#include "hammer_loads/life/life_settings.h"

namespace hammer_loads::life {

struct LedgerChannel {
  std::string name;
  LoadGrid grid;
  std::optional<SnCurve> curve;
  std::optional<FkmMeanStress> mean_stress;
  std::int64_t id{};  ///< number in the ledger; 0: it is not from one

  bool hasCountsOf(const LedgerChannel& o) const { return name == o.name && grid == o.grid; }
};

/// The machine of the counts. Another identity or other channels or grids begin a new epoch: counts of different
/// machines never mix. Curves and equivalent cycles only judge them: those of the last run hold.
struct LedgerMachine {
  std::string identity;  ///< identity of hammer and boom, such as a hash of their parameters; no path, host or time
  std::vector<LedgerChannel> channels;
  double equivalent_cycles_per_hour{};
};

/// Channels in the order of LifeRecorder::channels().
LedgerMachine ledgerMachine(const LifeSettings& settings, const std::string& identity);

/// One recording of one machine with one set of sensor parameters.
struct RunId {
  std::string name;          ///< equal whenever this recording is counted, with whatever sensor parameters
  std::string parameters{};  ///< a digest of those of sensors; empty: not known
  std::string refusal{};     ///< reason why it is not to be counted, one line; empty: it is

  RunId(const char* of) : name(of) {}
  RunId(std::string of) : name(std::move(of)) {}
};

constexpr std::size_t kSlopeCount = std::size(kSlopes);

/// Ranges in the channel's unit.
struct ChannelFigures {
  std::array<Figure, kSlopeCount> equivalent_range;  ///< at kSlopes; NaN without any time
  double largest_range{};
  double cycles{};                        ///< half cycles of the residue included
  std::optional<Figure> damage;           ///< by the channel's S-N curve
  std::optional<Figure> remaining_hours;  ///< until the damage is 1
};

/// The figures of a count over some hours.
ChannelFigures figuresOf(const CycleCount& count, const LedgerChannel& channel, double hours,
                         double equivalent_cycles_per_hour);

}  // namespace hammer_loads::life
